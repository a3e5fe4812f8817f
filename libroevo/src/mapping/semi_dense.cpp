#include "mapping/semi_dense.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "nearest.h"

namespace roevo {
namespace {

constexpr int kRadius = 3;  // px around an edge point
constexpr float kMostSteps = std::numeric_limits<std::int16_t>::max();

/// The pixels within `radius` of the origin.
std::vector<cv::Point> disc(int radius) {
    std::vector<cv::Point> pixels;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            if (x * x + y * y <= radius * radius) pixels.emplace_back(x, y);
    return pixels;
}

bool isInside(const cv::Mat& image, const cv::Point& pixel) {
    return pixel.inside(cv::Rect(0, 0, image.cols, image.rows));
}

bool isSurface(const cv::Mat& depth, const cv::Point& pixel, const SurfaceLimits& limits) {
    const auto near = static_cast<float>(limits.min_depth), far = static_cast<float>(limits.max_depth);
    const auto isKnown = [&](float z) { return z >= near && z <= far; };
    float nearest = depth.at<float>(pixel), farthest = nearest;
    if (!isKnown(nearest)) return false;
    for (const cv::Point& step :
         {cv::Point(-1, -1), {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}) {
        if (!isInside(depth, pixel + step)) continue;
        const float z = depth.at<float>(pixel + step);
        if (!isKnown(z)) continue;
        nearest = std::min(nearest, z);
        farthest = std::max(farthest, z);
    }
    return farthest <= (1 + static_cast<float>(limits.jump)) * nearest;
}

/// At a pixel of the ideal camera, from the nearest one of the real camera. None where there is no surface.
std::optional<ColouredPoint> pointAt(const RgbdFrame& frame, const PinholeCamera& camera,
                                     const SurfaceLimits& limits, const cv::Point& ideal) {
    const Eigen::Vector2d seen = camera.distortPixel(Eigen::Vector2d(ideal.x, ideal.y));
    if (!(seen.x() > -0.5 && seen.x() < camera.width - 0.5 && seen.y() > -0.5 &&
          seen.y() < camera.height - 0.5))
        return std::nullopt;
    const cv::Point real(nearestInteger(seen.x()), nearestInteger(seen.y()));
    if (!isSurface(frame.depth, real, limits)) return std::nullopt;
    const double z = frame.depth.at<float>(real);
    return ColouredPoint{camera.backProject(ideal.x, ideal.y, z).cast<float>(),
                         colourAt(frame, real.x, real.y)};
}

}  // namespace

Rgb colourAt(const RgbdFrame& frame, int u, int v) {
    if (!frame.colour.empty()) {
        const auto& bgr = frame.colour.at<cv::Vec3b>(v, u);
        return {bgr[2], bgr[1], bgr[0]};
    }
    const auto level = frame.grey.at<std::uint8_t>(v, u);
    return {level, level, level};
}

std::vector<ColouredPoint> sampleSemiDense(const OrganizedEdges& edges, const RgbdFrame& frame,
                                           const PinholeCamera& camera, int radius_px,
                                           const SurfaceLimits& limits, int max_points) {
    std::vector<ColouredPoint> points;
    if (frame.depth.empty() || max_points <= 0) return points;
    constexpr std::size_t kScatter = 11;  // neighbours along an edge look to different sides
    const auto wanted = static_cast<std::size_t>(max_points);
    const auto around = disc(radius_px);
    cv::Mat1b tried(camera.height, camera.width, std::uint8_t{0});
    // In each round a point has one pixel of its disc to offer
    for (std::size_t round = 0; round < around.size() && points.size() < wanted; ++round) {
        const std::size_t asked = std::min(edges.size(), wanted - points.size());
        for (std::size_t k = 0; k < asked; ++k) {
            const std::size_t i = k * edges.size() / asked;
            const cv::Point centre(nearestInteger(edges.x[i]), nearestInteger(edges.y[i]));
            const cv::Point pixel = centre + around[(kScatter * i + round) % around.size()];
            if (!isInside(tried, pixel) || tried(pixel) != 0) continue;
            tried(pixel) = 1;
            if (const auto point = pointAt(frame, camera, limits, pixel)) points.push_back(*point);
        }
    }
    return points;
}

PackedPoints::PackedPoints(const std::vector<ColouredPoint>& points) {
    float largest = 0;
    for (const ColouredPoint& point : points)
        largest = std::max(largest, point.position.cwiseAbs().maxCoeff());
    if (largest == 0) return;
    step_ = largest / kMostSteps;
    points_.reserve(points.size());
    for (const ColouredPoint& point : points) {
        Packed packed{{}, point.colour};
        for (int axis = 0; axis < 3; ++axis)
            packed.position[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(
                std::clamp(std::round(point.position[axis] / step_), -kMostSteps, kMostSteps));
        points_.push_back(packed);
    }
}

ColouredPoint PackedPoints::at(std::size_t i) const {
    const Packed& packed = points_[i];
    return {step_ * Eigen::Vector3f(packed.position[0], packed.position[1], packed.position[2]),
            packed.colour};
}

void SemiDenseStore::add(const OrganizedEdges& edges, const RgbdFrame& frame, const RowMotion& rows) {
    auto points = sampleSemiDense(edges, frame, camera_, kRadius, limits_, max_points_);
    for (ColouredPoint& point : points) {
        const Eigen::Vector3d seen = point.position.cast<double>();
        point.position = rows.toReference(seen, camera_.project(seen).y()).cast<float>();
    }
    keyframes_.emplace_back(points);
}

std::vector<ColouredPoint> SemiDenseStore::inWorld(const std::vector<KeyframeInfo>& keyframes,
                                                   std::size_t first) const {
    std::vector<ColouredPoint> world;
    for (std::size_t k = first; k < keyframes_.size(); ++k) {
        const Pose& T_world_camera = keyframes.at(k).T_world_camera;
        for (std::size_t i = 0; i < keyframes_[k].size(); ++i) {
            ColouredPoint point = keyframes_[k].at(i);
            point.position = (T_world_camera * point.position.cast<double>()).cast<float>();
            world.push_back(point);
        }
    }
    return world;
}

}  // namespace roevo
