#include "semi_dense_store.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace roevo {
namespace {

constexpr int kRadius = 3;  // px around an edge point
constexpr float kMostSteps = std::numeric_limits<std::int16_t>::max();

}  // namespace

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

void SemiDenseStore::add(const OrganizedEdges& edges, const Frame& frame, const RowMotion& rows) {
    auto points = sampleSemiDense(edges, frame.images, camera_, kRadius, limits_, max_points_);
    for (ColouredPoint& point : points) {
        const Eigen::Vector3d seen = point.position.cast<double>();
        point.position = rows.toReference(seen, camera_.project(seen).y()).cast<float>();
    }
    keyframes_.emplace_back(points);
}

std::vector<ColouredPoint> SemiDenseStore::inWorld(const std::vector<KeyframeInfo>& keyframes,
                                                   std::size_t first) const {
    std::size_t count = 0;
    for (const PackedPoints& points : keyframes_) count += points.size();
    std::vector<ColouredPoint> world;
    world.reserve(count);
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
