#pragma once
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// Where a texture is looked up.
struct SurfacePoint {
    float u = 0, v = 0;            ///< metres from the middle of the face, v upwards where there is an up
    float half_u = 1, half_v = 1;  ///< half sizes of the face, metres
    float footprint = 0.001f;  ///< metres: width of the sample on the surface; detail below it is faded out
};

/// Reflectance of a surface, 0..1 per channel. A pure function, smooth at the scale of the footprint.
Colour textureColour(const Material& material, const SurfacePoint& point);

}  // namespace roevo::simulator
