#pragma once
#include <algorithm>
#include <cmath>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// How far the principal point is from the middle of the image, as a share of its side. Cameras are off by
/// some hundredths; more is often of intrinsics for images of another size.
inline double offCentre(const PinholeCamera& camera) {
    const auto off = [](double centre, int side) { return std::abs((centre + 0.5) / side - 0.5); };
    return std::max(off(camera.cx, camera.width), off(camera.cy, camera.height));
}

}  // namespace roevo
