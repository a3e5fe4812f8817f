#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"

namespace roevo::testing {

/// A textured room with two balls in it, seen exactly from any pose by any camera. x right, y down, z
/// forward.
struct AnalyticRoom {
    /// Distance along `ray` from `from` to the nearest surface, in lengths of the ray.
    static double hit(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
        double nearest = std::numeric_limits<double>::infinity();
        const auto consider = [&](double t) {
            if (t > 0 && t < nearest) nearest = t;
        };
        const std::array<double, 3> low{-1.5, -1.1, -3}, high{1.7, 1.2, 3.2};
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            consider((low[i] - from[axis]) / ray[axis]);
            consider((high[i] - from[axis]) / ray[axis]);
        }
        for (const Eigen::Vector4d& ball :
             {Eigen::Vector4d(-0.6, 0.4, 2.2, 0.5), Eigen::Vector4d(0.7, -0.3, 2.6, 0.4)}) {
            const Eigen::Vector3d to = ball.head<3>() - from;
            const double along = ray.dot(to) / ray.squaredNorm();
            const double rest = ball.w() * ball.w() - (to - along * ray).squaredNorm();
            if (rest > 0) consider(along - std::sqrt(rest / ray.squaredNorm()));
        }
        return nearest;
    }

    /// Grey levels; slopes of some 20 levels per pixel, over many pixels.
    static double texture(const Eigen::Vector3d& p) {
        const double a = p.x() + 0.7 * p.z(), b = p.y() - 0.4 * p.z();
        return 128 + 45 * std::sin(26 * a + 9 * b) + 40 * std::cos(23 * b - 14 * a) +
               35 * std::sin(7 * a + 8 * b);
    }

    static RgbdFrame frame(const PinholeCamera& camera, const Pose& T_world_camera, double timestamp) {
        const auto rayAt = [&](double u, double v) {
            Eigen::Vector2d ideal(u, v);
            if (camera.isDistorted()) {
                for (int i = 0; i < 20; ++i) ideal += Eigen::Vector2d(u, v) - camera.distortPixel(ideal);
            }
            return Eigen::Vector3d(T_world_camera.linear() * camera.backProject(ideal.x(), ideal.y(), 1));
        };
        const Eigen::Vector3d from = T_world_camera.translation();
        RgbdFrame frame;
        frame.timestamp = timestamp;
        frame.grey.create(camera.height, camera.width, CV_8UC1);
        frame.depth.create(camera.height, camera.width, CV_32FC1);
        for (int v = 0; v < camera.height; ++v) {
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = rayAt(u, v);
                const double depth = hit(from, ray);
                frame.depth.at<float>(v, u) = static_cast<float>(depth);
                frame.grey.at<std::uint8_t>(v, u) =
                    cv::saturate_cast<std::uint8_t>(texture(from + depth * ray));
            }
        }
        return frame;
    }
};

}  // namespace roevo::testing
