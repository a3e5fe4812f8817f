#pragma once
#include <algorithm>

#include "roevo/camera/pinhole_camera.h"
#include "tracking/kernels.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// How much less certain an edge's place is because it moves. While the shutter is open a moving edge is
/// smeared, and it is where the image has it at a time that is known to some milliseconds only; both matter
/// where the edge moves across itself, and not along it. One sigma of that time makes of a speed across the
/// edge a standard deviation in pixels, which adds to that of an edge at rest.
class MotionBlur {
  public:
    /// @param rows     how the camera moves; unknown: as if it stood still
    /// @param seconds  one sigma of the time at which an edge was seen (sensor.blur_time); 0: all are sharp
    MotionBlur(const RowMotion& rows, const PinholeCamera& camera, double seconds)
        : vx_(static_cast<float>(rows.velocity.x())),
          vy_(static_cast<float>(rows.velocity.y())),
          vz_(static_cast<float>(rows.velocity.z())),
          wx_(static_cast<float>(rows.turn.x())),
          wy_(static_cast<float>(rows.turn.y())),
          wz_(static_cast<float>(rows.turn.z())),
          to_sigmas_x_(static_cast<float>(camera.fx * seconds / atRest(camera))),
          to_sigmas_y_(static_cast<float>(camera.fy * seconds / atRest(camera))) {}

    /// Variance across an edge with unit normal (nx, ny) at a point of the camera frame (m) that its motion
    /// adds, relative to that of an edge at rest.
    float variance(float x, float y, float z, float nx, float ny) const {
        const float inverse = 1 / z, a = x * inverse, b = y * inverse;
        const float towards = vz_ * inverse + wx_ * b - wy_ * a;
        const float u = vx_ * inverse + wy_ - wz_ * b - a * towards;
        const float v = vy_ * inverse + wz_ * a - wx_ - b * towards;
        const float sigmas = to_sigmas_x_ * nx * u + to_sigmas_y_ * ny * v;
        return sigmas * sigmas;
    }

    /// For the kernels, which do the same.
    kernels::CameraMotion motion() const {
        return {{vx_, vy_, vz_}, {wx_, wy_, wz_}, to_sigmas_x_, to_sigmas_y_};
    }

    /// One sigma across an edge at rest, px. Of larger images edges are found in as large a part of the
    /// scene, see scaledTo().
    static double atRest(const PinholeCamera& camera) { return std::max(1., camera.width / 640.) / 3; }

  private:
    float vx_, vy_, vz_, wx_, wy_, wz_, to_sigmas_x_, to_sigmas_y_;
};

}  // namespace roevo
