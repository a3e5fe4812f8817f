#include "roevo/camera/depth_registration.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace roevo {
namespace {

/// Ideal normalised coordinates of every pixel of a (possibly distorted) camera, as CV_32FC2. Inverts the
/// lens by fixed-point iteration, which converges for any lens whose image does not fold over itself.
cv::Mat normalisedRays(const PinholeCamera& camera) {
    cv::Mat rays(camera.height, camera.width, CV_32FC2);
    const bool distorted = camera.isDistorted();
    for (int v = 0; v < camera.height; ++v) {
        auto* row = rays.ptr<cv::Vec2f>(v);
        for (int u = 0; u < camera.width; ++u) {
            Eigen::Vector2d ideal(u, v);
            for (int i = 0; distorted && i < 20; ++i) {
                ideal += Eigen::Vector2d(u, v) - camera.distortPixel(ideal);
            }
            row[u] = cv::Vec2f(static_cast<float>((ideal.x() - camera.cx) / camera.fx),
                               static_cast<float>((ideal.y() - camera.cy) / camera.fy));
        }
    }
    return rays;
}

void requireDepth(const cv::Mat& depth, const PinholeCamera& camera) {
    if (depth.type() != CV_32FC1 || depth.cols != camera.width || depth.rows != camera.height) {
        throw std::invalid_argument("depth image must be 32-bit float of the depth camera's size " +
                                    std::to_string(camera.width) + "x" + std::to_string(camera.height));
    }
}

/// The depth image as a mesh is hole-free in the colour image; as points it is not when the colour image is
/// finer. Each depth pixel is therefore splatted over the colour pixels that its footprint covers.
int splatRadius(double depth_focal, double colour_focal, double depth_z, double colour_z) {
    const double footprint = colour_focal / depth_focal * depth_z / colour_z;
    return std::clamp(static_cast<int>(std::ceil((footprint - 1) / 2)), 0, 4);
}

}  // namespace

cv::Mat registerDepth(const cv::Mat& depth, const PinholeCamera& depth_camera,
                      const PinholeCamera& colour_camera, const Pose& T_colour_depth) {
    requireDepth(depth, depth_camera);
    const cv::Mat rays = normalisedRays(depth_camera);
    const bool distorted = colour_camera.isDistorted();
    cv::Mat registered = cv::Mat::zeros(colour_camera.height, colour_camera.width, CV_32FC1);
    for (int v = 0; v < depth.rows; ++v) {
        for (int u = 0; u < depth.cols; ++u) {
            const double z = depth.at<float>(v, u);
            if (!(z > 0) || !std::isfinite(z)) continue;
            const cv::Vec2f& ray = rays.at<cv::Vec2f>(v, u);
            const Eigen::Vector3d point = T_colour_depth * Eigen::Vector3d(ray[0] * z, ray[1] * z, z);
            if (point.z() <= 0) continue;
            Eigen::Vector2d pixel = colour_camera.project(point);
            if (pixel.x() < -colour_camera.width || pixel.x() > 2 * colour_camera.width ||
                pixel.y() < -colour_camera.height || pixel.y() > 2 * colour_camera.height) {
                continue;  // far outside, where the lens polynomial may fold back into the image
            }
            if (distorted) pixel = colour_camera.distortPixel(pixel);
            const int radius = splatRadius(depth_camera.fx, colour_camera.fx, z, point.z());
            const int cu = static_cast<int>(std::lround(pixel.x())),
                      cv_ = static_cast<int>(std::lround(pixel.y()));
            for (int y = std::max(0, cv_ - radius); y <= std::min(registered.rows - 1, cv_ + radius); ++y) {
                for (int x = std::max(0, cu - radius); x <= std::min(registered.cols - 1, cu + radius); ++x) {
                    float& nearest = registered.at<float>(y, x);
                    if (nearest == 0 || point.z() < nearest) nearest = static_cast<float>(point.z());
                }
            }
        }
    }
    return registered;
}

void rangeToDepth(cv::Mat& range, const PinholeCamera& depth_camera) {
    requireDepth(range, depth_camera);
    const cv::Mat rays = normalisedRays(depth_camera);
    for (int v = 0; v < range.rows; ++v) {
        auto* values = range.ptr<float>(v);
        const auto* row = rays.ptr<cv::Vec2f>(v);
        for (int u = 0; u < range.cols; ++u) {
            values[u] /= std::sqrt(1 + row[u][0] * row[u][0] + row[u][1] * row[u][1]);
        }
    }
}

}  // namespace roevo
