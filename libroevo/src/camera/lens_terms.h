#pragma once
#include <cstddef>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// The terms of a lens in one row, as OpenCV has them: k1 k2 p1 p2 k3 k4 k5 k6; of a fish-eye k1 k2 k3 k4.
template <class Camera>
auto& lensTerm(Camera& camera, std::size_t i) {
    const std::size_t first = camera.distortion.size();
    return i < first ? camera.distortion[i] : camera.denominator[i - first];
}

}  // namespace roevo
