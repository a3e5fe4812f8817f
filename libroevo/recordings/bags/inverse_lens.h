#pragma once
#include <array>
#include <vector>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// The lens of a camera that RealSense calls "Inverse Brown Conrady": its five terms (k1 k2 p1 p2 k3) lead
/// from the pixel to the ray, where ours lead from the ray to the pixel. Ours are fitted to it over the
/// image.
/// @param ideal  intrinsics without distortion
/// @throws std::runtime_error when they differ by more than 0.1 pixels somewhere
std::array<double, 5> distortionOfInverse(const PinholeCamera& ideal, const std::vector<double>& terms);

}  // namespace roevo
