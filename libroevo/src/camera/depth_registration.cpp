#include "roevo/camera/depth_registration.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace roevo {
namespace {

/// Ideal normalised coordinates of every pixel of a (possibly distorted) camera, as CV_32FC2. Those of the
/// last camera are kept: a recording asks for the same ones frame after frame.
const cv::Mat& raysOf(const PinholeCamera& camera) {
    thread_local PinholeCamera known;
    thread_local cv::Mat rays;
    if (!rays.empty() && known == camera) return rays;
    known = camera;
    rays.create(camera.height, camera.width, CV_32FC2);
    for (int v = 0; v < camera.height; ++v) {
        auto* row = rays.ptr<cv::Vec2f>(v);
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector2d ideal = camera.undistortPixel(Eigen::Vector2d(u, v));
            row[u] = cv::Vec2f(static_cast<float>((ideal.x() - camera.cx) / camera.fx),
                               static_cast<float>((ideal.y() - camera.cy) / camera.fy));
        }
    }
    return rays;
}

/// Of any size: there are depth cameras of 8x8 pixels.
void requireCamera(const PinholeCamera& camera) {
    const double numbers = camera.fx + camera.fy + camera.cx + camera.cy;
    if (camera.width <= 0 || camera.height <= 0 || !(camera.fx > 0) || !(camera.fy > 0) ||
        !std::isfinite(numbers))
        throw std::invalid_argument("a camera without size or intrinsics sees no depth");
}

void requireDepth(const cv::Mat& depth, const PinholeCamera& camera) {
    requireCamera(camera);
    if (depth.type() != CV_32FC1 || depth.cols != camera.width || depth.rows != camera.height) {
        throw std::invalid_argument("depth image must be 32-bit float of the depth camera's size " +
                                    std::to_string(camera.width) + "x" + std::to_string(camera.height));
    }
}

}  // namespace

cv::Mat registerDepth(const cv::Mat& depth, const PinholeCamera& depth_camera,
                      const PinholeCamera& colour_camera, const Pose& T_colour_depth) {
    requireDepth(depth, depth_camera);
    requireCamera(colour_camera);
    if (!T_colour_depth.matrix().allFinite())
        throw std::invalid_argument("the pose of the depth camera is not finite");
    const cv::Mat& rays = raysOf(depth_camera);
    const bool distorted = colour_camera.isDistorted();
    const double farthest = colour_camera.unfoldedRadiusSquared();
    cv::Mat registered(colour_camera.height, colour_camera.width, CV_32FC1, cv::Scalar(0));
    for (int v = 0; v < depth.rows; ++v) {
        for (int u = 0; u < depth.cols; ++u) {
            const double z = depth.at<float>(v, u);
            if (!(z > 0) || !std::isfinite(z)) continue;
            const cv::Vec2f& ray = rays.at<cv::Vec2f>(v, u);
            const Eigen::Vector3d point = T_colour_depth * Eigen::Vector3d(ray[0] * z, ray[1] * z, z);
            // Written so that a ray that is not a number, from a lens that cannot be inverted there, is left
            // out as well
            if (!(point.z() > 0 && point.head<2>().squaredNorm() <= farthest * point.z() * point.z()))
                continue;
            Eigen::Vector2d pixel = colour_camera.project(point);
            if (distorted) pixel = colour_camera.distortPixel(pixel);
            // Of what the depth pixel covers: at least half a pixel, so that no hole opens, at most a few
            const double half_x =
                std::clamp(0.55 * colour_camera.fx / depth_camera.fx * z / point.z(), 0.5, 4.5);
            const double half_y =
                std::clamp(0.55 * colour_camera.fy / depth_camera.fy * z / point.z(), 0.5, 4.5);
            if (!(pixel.x() > -half_x && pixel.x() < registered.cols - 1 + half_x && pixel.y() > -half_y &&
                  pixel.y() < registered.rows - 1 + half_y)) {
                continue;
            }
            const int x0 = std::max(0, static_cast<int>(std::ceil(pixel.x() - half_x)));
            const int x1 = std::min(registered.cols - 1, static_cast<int>(std::floor(pixel.x() + half_x)));
            const int y0 = std::max(0, static_cast<int>(std::ceil(pixel.y() - half_y)));
            const int y1 = std::min(registered.rows - 1, static_cast<int>(std::floor(pixel.y() + half_y)));
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
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
    const cv::Mat& rays = raysOf(depth_camera);
    for (int v = 0; v < range.rows; ++v) {
        auto* values = range.ptr<float>(v);
        const auto* row = rays.ptr<cv::Vec2f>(v);
        for (int u = 0; u < range.cols; ++u) {
            values[u] /= std::sqrt(1 + row[u][0] * row[u][0] + row[u][1] * row[u][1]);
        }
    }
}

}  // namespace roevo
