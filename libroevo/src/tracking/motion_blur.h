#pragma once
#include <algorithm>

#include "kernels/kernels.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

// How much less certain an edge's place is because it moves. While the shutter is open a moving edge is
// smeared, and it is where the image has it at a time that is known to some milliseconds only; both matter
// where the edge moves across itself, and not along it. One sigma of that time makes of a speed across the
// edge a standard deviation in pixels, which adds to that of an edge at rest.

/// One sigma across an edge at rest, px. Of larger images edges are found in as large a part of the scene,
/// see scaledTo().
inline double sigmaAtRest(const PinholeCamera& camera) {
    return std::max(1., camera.width / 640.) / 3;
}

/// @param rows     how the camera moves; unknown: as if it stood still
/// @param seconds  one sigma of the time at which an edge was seen (sensor.blur_time); 0: all are sharp
inline kernels::CameraMotion cameraMotion(const RowMotion& rows, const PinholeCamera& camera,
                                          double seconds) {
    kernels::CameraMotion motion;
    for (int k = 0; k < 3; ++k) {
        motion.velocity[k] = static_cast<float>(rows.velocity[k]);
        motion.turn[k] = static_cast<float>(rows.turn[k]);
    }
    motion.to_sigmas_x = static_cast<float>(camera.fx * seconds / sigmaAtRest(camera));
    motion.to_sigmas_y = static_cast<float>(camera.fy * seconds / sigmaAtRest(camera));
    return motion;
}

/// Variance across an edge with unit normal (nx, ny) at a point of the camera frame (m) that motion adds,
/// relative to that of an edge at rest. The kernel `blur` does the same.
inline float blurVariance(const kernels::CameraMotion& motion, float x, float y, float z, float nx,
                          float ny) {
    const auto& [velocity, turn, to_sigmas_x, to_sigmas_y] = motion;
    const float inverse = 1 / z, a = x * inverse, b = y * inverse;
    const float towards = velocity[2] * inverse + turn[0] * b - turn[1] * a;
    const float u = velocity[0] * inverse + turn[1] - turn[2] * b - a * towards;
    const float v = velocity[1] * inverse + turn[2] * a - turn[0] - b * towards;
    const float sigmas = to_sigmas_x * nx * u + to_sigmas_y * ny * v;
    return sigmas * sigmas;
}

}  // namespace roevo
