#include "semi_dense_store.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "mapping/semi_dense.h"

namespace roevo {
namespace {

constexpr int kRadius = 3;                // px around an edge point
constexpr std::size_t kMostSampling = 3;  // keyframes at a time
constexpr float kMostSteps = std::numeric_limits<std::int16_t>::max();

/// Forgets depths that make no surface: out of the sensor's good range, and where depth jumps to the next
/// pixel, since there sensors average over both sides.
void keepSurfaces(cv::Mat& depth, const SensorOptions& sensor, double jump) {
    depth.setTo(0, (depth < sensor.min_depth) | (depth > sensor.max_depth));
    cv::Mat farthest, nearest = depth.clone();
    nearest.setTo(std::numeric_limits<float>::max(), depth == 0);
    const cv::Mat neighbours(3, 3, CV_8UC1, cv::Scalar(1));
    cv::erode(nearest, nearest, neighbours);
    cv::dilate(depth, farthest, neighbours);
    depth.setTo(0, farthest > (1 + jump) * nearest);
}

/// Every third point: around these the pixels are as good as around all.
void thinInto(OrganizedEdges& out, const OrganizedEdges& edges) {
    out.clear();
    for (std::size_t i = 1; i < edges.size(); i += 3) out.addPoint(edges.x[i], edges.y[i], 0, 0, 0);
    out.finishEdge();
}

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

SemiDenseStore::Job SemiDenseStore::sample(Job job) const {
    keepSurfaces(job.frame.depth, sensor_, depth_jump_);
    auto points = sampleSemiDense(job.centres, job.frame, camera_, kRadius, max_points_);
    for (ColouredPoint& point : points) {
        const Eigen::Vector3d seen = point.position.cast<double>();
        point.position = job.rows.toReference(seen, camera_.project(seen).y()).cast<float>();
    }
    job.points = PackedPoints(points);
    return job;
}

void SemiDenseStore::add(const OrganizedEdges& edges, const Frame& frame, const RowMotion& rows) {
    if (max_points_ == 0) return;
    collect(kMostSampling - 1);
    Job job;
    if (!spare_.empty()) {
        job = std::move(spare_.back());
        spare_.pop_back();
    }
    thinInto(job.centres, edges);
    frame.images.grey.copyTo(job.frame.grey);
    frame.images.depth.copyTo(job.frame.depth);
    frame.images.colour.copyTo(job.frame.colour);
    job.rows = rows;
    sampling_.push_back(std::async(launch_, &SemiDenseStore::sample, this, std::move(job)));
}

void SemiDenseStore::collect(std::size_t most_sampling) {
    const auto ready = [](const std::future<Job>& job) {
        return job.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    while (!sampling_.empty() && (sampling_.size() > most_sampling || ready(sampling_.front()))) {
        Job done = sampling_.front().get();
        sampling_.pop_front();
        keyframes_.push_back(std::move(done.points));
        spare_.push_back(std::move(done));
    }
}

const std::vector<PackedPoints>& SemiDenseStore::keyframes() {
    collect(0);
    return keyframes_;
}

std::vector<ColouredPoint> SemiDenseStore::inWorld(const std::vector<KeyframeInfo>& keyframes,
                                                   std::size_t first) {
    collect(0);
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
