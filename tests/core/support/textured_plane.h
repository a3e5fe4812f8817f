#pragma once
#include <cmath>
#include <opencv2/core.hpp>

#include "core/support/analytic_image.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace roevo::testing {

/// A slanted plane n . p = d (world frame) with a smooth texture, seen exactly from any pose.
struct TexturedPlane {
    Eigen::Vector3d n{0.15, -0.1, 1};
    double d = 2;

    static double texture(const Eigen::Vector3d& p) {
        return 125 + 35 * std::sin(7 * p.x() + 2 * p.y()) + 30 * std::cos(6 * p.y() - 3 * p.x() + 1) +
               25 * std::sin(9 * p.x() - 8 * p.y());
    }
    Eigen::Vector3d hit(const PinholeCamera& camera, const Pose& T_world_camera, double u, double v) const {
        const Eigen::Vector3d ray = T_world_camera.linear() * camera.backProject(u, v, 1);
        return T_world_camera.translation() + (d - n.dot(T_world_camera.translation())) / n.dot(ray) * ray;
    }
    /// @param gain, offset  of the grey levels, which are about 35 to 215 with none
    cv::Mat grey(const PinholeCamera& camera, const Pose& T_world_camera, double gain = 1,
                 double offset = 0) const {
        return renderGrey(
            camera.width, camera.height,
            [&](double x, double y) { return gain * texture(hit(camera, T_world_camera, x, y)) + offset; },
            2);
    }
    double depth(const PinholeCamera& camera, const Pose& T_world_camera, double u, double v) const {
        return (T_world_camera.inverse() * hit(camera, T_world_camera, u, v)).z();
    }
};

}  // namespace roevo::testing
