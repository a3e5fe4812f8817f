#include "tracking/edge_term.h"

#include <algorithm>
#include <cmath>

#include "edges/edge_depth.h"
#include "tracking/motion_blur.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

/// Once the search radius is the final one, points stay with the edges that they were associated with until
/// the image has moved so far since, px: what is nearer then lies on the same edge.
constexpr double kSameEdges = 1.5;
constexpr double kNarrowing = 2;    ///< iterations in which the radius narrows down
constexpr int kFirstPoints = 1600;  ///< looked up as it does
/// Neighbours along an edge look at much the same pixels of the depth image: every n-th speaks for all.
constexpr std::size_t kDepthStride = 3;
constexpr float kUnknown = -1;  ///< depth or blur not looked up yet

}  // namespace

EdgeTerm::EdgeTerm(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      ideal_(camera.undistorted()),
      options_(options.fine),
      edge_options_(options.edges),
      sensor_(options.sensor),
      associator_(options.fine) {}

void EdgeTerm::look(const Keyframe& keyframe, const Frame& frame) {
    if (frame_ != &frame || looked_at_ != frame.timestamp() || current_depth_.size() != frame.edges.size())
        current_depth_.assign(frame.edges.size(), kUnknown);
    looked_at_ = frame.timestamp();
    keyframe_ = &keyframe;
    keyframe_blur_.assign(keyframe.edges.size(), kUnknown);
    frame_ = &frame;
    free_readout_ = has_associated_ = false;
    associator_.limit(options_.max_points);
}

void EdgeTerm::start(const Keyframe& keyframe, const Frame& frame) {
    frame_ = nullptr;  // whatever was looked up is another frame's
    look(keyframe, frame);
}

void EdgeTerm::startReadout(const Keyframe& keyframe, const Frame& frame, const EdgeMatches& matches) {
    look(keyframe, frame);
    free_readout_ = true;
    matches_ = matches;
}

int EdgeTerm::narrowed() const {
    return static_cast<int>(std::clamp(options_.max_iterations - 1.0, 1.0, kNarrowing));
}

bool EdgeTerm::linearise(const Linearisation& at, PoseSystem& system) {
    const double share = std::min(1.0, static_cast<double>(at.iteration) / narrowed());
    const double radius = options_.search_radius + share * (options_.final_radius - options_.search_radius);
    project(at.T_current_keyframe, at.rows);
    const auto moved = [&] {
        return imageMotion(T_associated_, at.T_current_keyframe, ideal_.fx, keyframe_->typicalDepth());
    };
    if (free_readout_ || (has_associated_ && moved() < kSameEdges)) {
        EdgeAssociator::follow(projected_.u.data(), projected_.v.data(), frame_->edges, matches_);
    } else {
        has_associated_ = share >= 1;
        const bool goes_on = at.iteration < narrowed() && narrowed() < options_.max_iterations;
        associator_.limit(std::min(options_.max_points, goes_on ? kFirstPoints : options_.max_points));
        associateProjected(at.T_current_keyframe, radius);
        T_associated_ = at.T_current_keyframe;
    }
    // min_inliers is of as many points as there may be
    const std::size_t needed = static_cast<std::size_t>(options_.min_inliers) *
                               strideFor(keyframe_->edges.size(), options_.max_points) / associator_.stride();
    if (matches_.size() < needed) return false;
    tangentResiduals(at.rows);
    weigh();
    if (free_readout_) {
        if (inliers_ < options_.min_inliers) return false;
        accumulateReadout(at, system);
        return true;
    }
    depthResiduals();
    accumulate(system);
    return true;
}

void EdgeTerm::associate(const Pose& T_current_keyframe, const RowMotion& rows, double radius) {
    project(T_current_keyframe, rows);
    associateProjected(T_current_keyframe, radius);
}

void EdgeTerm::assess(const Pose& T_current_keyframe, const RowMotion& rows) {
    associate(T_current_keyframe, rows, options_.final_radius);
    tangentResiduals(rows);
    weigh();
}

void EdgeTerm::project(const Pose& pose, const RowMotion& rows) {
    const EdgePoints3D& edges = keyframe_->edges;
    const RowMotion& then = keyframe_->row_motion;
    const bool moves = free_readout_ && rows.seconds_per_row != then.seconds_per_row;
    if (moves) {  // those that count
        moved_ = edges.points;
        exchangeMotion(then, then.at(rows.seconds_per_row), edges.image.y, matches_.reference, moved_);
    }
    roevo::project(moves ? moved_ : edges.points, pose, ideal_, rows, projected_);
}

void EdgeTerm::associateProjected(const Pose& T_current_keyframe, double radius) {
    associator_.associate(keyframe_->edges.image, projected_.u.data(), projected_.v.data(),
                          imageRotation(T_current_keyframe), edge_options_.tangent_span, frame_->edges,
                          frame_->grid, ideal_.width, ideal_.height, radius, matches_);
}

void EdgeTerm::tangentResiduals(const RowMotion& rows) {
    const OrganizedEdges& current = frame_->edges;
    const EdgePoints3D& edges = keyframe_->edges;
    const MotionBlur now(rows, ideal_, sensor_.blur_time),
        then(keyframe_->row_motion, ideal_, sensor_.blur_time);
    residual_.resize(matches_.size());
    sharpness_.resize(matches_.size());
    scratch_.clear();
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        // Eq. (7), as a signed scalar across the tangent (its square and normal equations are the same),
        // about the associated point rather than its predecessor: unbiased where the edge is curved
        residual_[k] = current.normal_x[p] * (projected_.u[i] - current.x[p]) +
                       current.normal_y[p] * (projected_.v[i] - current.y[p]);
        float& blurred_then = keyframe_blur_[i];
        if (blurred_then == kUnknown)
            blurred_then = then.variance(edges.points.x[i], edges.points.y[i], edges.points.z[i],
                                         edges.image.normal_x[i], edges.image.normal_y[i]);
        const float blurred_now = now.variance(projected_.x[i], projected_.y[i], projected_.z[i],
                                               current.normal_x[p], current.normal_y[p]);
        sharpness_[k] = 1 / (1 + (blurred_now + blurred_then));
        scratch_.push_back(std::abs(residual_[k]) * std::sqrt(sharpness_[k]));
    }
    if (!scratch_.empty()) scale_ = robustScale(scratch_);
}

double EdgeTerm::depthAgreement() {
    constexpr double kSigmas = 3, kFloor = 0.02;  // m: foregrounds are found differently from elsewhere
    int known = 0, agreed = 0;
    if (!use_depth_ || frame_->images.depth.empty()) return 1;
    for (std::size_t k = 0; k < matches_.size(); k += kDepthStride) {
        if (weight_[k] <= 0) continue;
        const double seen = static_cast<double>(currentDepth(static_cast<std::size_t>(matches_.current[k])));
        if (seen <= 0) continue;
        const auto z = static_cast<double>(projected_.z[static_cast<std::size_t>(matches_.reference[k])]);
        const double sigma = sensor_.depthSigma(seen);
        ++known;
        if ((z - seen) * (z - seen) < kSigmas * kSigmas * (2 * sigma * sigma + kFloor * kFloor)) ++agreed;
    }
    return known > 0 ? static_cast<double>(agreed) / known : 1;
}

float EdgeTerm::currentDepth(std::size_t point) {
    float& measured = current_depth_[point];
    if (measured != kUnknown) return measured;
    const Eigen::Vector2d pixel = camera_.distortPixel({frame_->edges.x[point], frame_->edges.y[point]});
    measured = foregroundDepth(frame_->images.depth, static_cast<float>(pixel.x()),
                               static_cast<float>(pixel.y()), edge_options_, sensor_)
                   .depth;
    return measured;
}

void EdgeTerm::depthResiduals() {
    const EdgePoints3D& edges = keyframe_->edges;
    depth_residual_.assign(matches_.size(), 0);
    depth_weight_.assign(matches_.size(), 0);
    if (!use_depth_ || options_.depth_weight <= 0 || frame_->images.depth.empty()) return;
    const auto chi2 = static_cast<float>(options_.depth_chi2);
    const auto floor2 = static_cast<float>(sensor_.depth_noise_floor * sensor_.depth_noise_floor);
    const auto noise2 = static_cast<float>(sensor_.depth_noise * sensor_.depth_noise);
    const auto weight = static_cast<float>(options_.depth_weight * kDepthStride);
    for (std::size_t k = 0; k < matches_.size(); k += kDepthStride) {
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const float measured = currentDepth(static_cast<std::size_t>(matches_.current[k]));
        if (measured <= 0) continue;
        const float z2 = measured * measured, reference2 = edges.points.z[i] * edges.points.z[i];
        const float variance = noise2 * (z2 * z2 + reference2 * reference2) + 2 * floor2;
        // What the sides of the edge add in the keyframe they would add here, too
        const float residual = projected_.z[i] - edges.correction[i] - measured;
        const float squared = residual * residual / variance;
        if (squared > chi2) continue;
        depth_residual_[k] = residual;
        // Not by its sharpness: the depth of a surface does not blur as its edge moves (weighed by it,
        // fr1_rpy lost a fifth)
        depth_weight_[k] = studentWeight(weight * edges.weight[i] / variance, squared);
    }
}

void EdgeTerm::weigh() {
    weight_.assign(matches_.size(), 0);
    inliers_ = 0;
    const auto inverse = static_cast<float>(1 / (scale_ * scale_));
    const auto chi2 = static_cast<float>(options_.chi2);
    double weights = 0, slopes = 0;
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const float information = sharpness_[k] * inverse;
        const float squared = residual_[k] * residual_[k] * information;
        if (squared > chi2) continue;
        ++inliers_;
        weight_[k] = studentWeight(
            keyframe_->edges.weight[static_cast<std::size_t>(matches_.reference[k])] * information, squared);
        weights += static_cast<double>(weight_[k]);
        slopes += static_cast<double>(weight_[k] * studentSlope(squared));
    }
    slope_ = weights > 0 ? std::max(slopes / weights, kLeastSlope) : 1;
}

void EdgeTerm::accumulate(PoseSystem& system) {
    const OrganizedEdges& current = frame_->edges;
    rows_.reset(matches_.size());
    const auto fx = static_cast<float>(ideal_.fx), fy = static_cast<float>(ideal_.fy);
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        if (weight_[k] <= 0) {
            rows_.leaveOut(k);
            continue;
        }
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        const float nx = current.normal_x[p], ny = current.normal_y[p], w = weight_[k], r = residual_[k];
        float matrix[6], vector[3];
        const float x = projected_.x[i], y = projected_.y[i], z = projected_.z[i];
        liftInformation(x, y, z, fx, fy, w * nx * nx, w * nx * ny, w * ny * ny, w * nx * r, w * ny * r,
                        matrix, vector);
        matrix[5] += depth_weight_[k];
        vector[2] += depth_weight_[k] * depth_residual_[k];
        rows_.set(k, matrix, vector, x, y, z);
    }
    system.add(rows_.sum());
}

void EdgeTerm::addTo(EdgeClusters& clusters) const {
    rows_.addTo(clusters, matches_.size(), [&](std::size_t k) {
        const auto point = static_cast<std::size_t>(matches_.reference[k]);
        return static_cast<std::size_t>(keyframe_->edges.image.edge_of[point]);
    });
}

void EdgeTerm::accumulateReadout(const Linearisation& at, PoseSystem& system) const {
    const RowMotion& rows = at.rows;
    const OrganizedEdges& current = frame_->edges;
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        if (weight_[k] <= 0) continue;
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        const Eigen::Vector3d point = projected_.at(i);
        const double a = ideal_.fx / point.z(), b = ideal_.fy / point.z();
        const Eigen::Vector2d normal(current.normal_x[p], current.normal_y[p]);
        const Eigen::Vector3d by_point(
            a * normal.x(), b * normal.y(),
            -(a * normal.x() * point.x() + b * normal.y() * point.y()) / point.z());
        const Eigen::Vector3d in_keyframe = keyframe_->edges.points.at(i);
        const double by_current = by_point.dot(rows.pointVelocity(point)) *
                                  (static_cast<double>(projected_.v[i]) - rows.reference_row);
        const double by_keyframe =
            -by_point.dot(at.T_current_keyframe.linear() * keyframe_->row_motion.pointVelocity(in_keyframe)) *
            (static_cast<double>(keyframe_->edges.image.y[i]) - rows.reference_row);
        const double by_readout = by_current + by_keyframe;
        const auto residual = static_cast<double>(residual_[k]);
        Vector6d by_pose;
        by_pose << by_point, point.cross(by_point);
        const auto weight = static_cast<double>(weight_[k]);
        system.hessian += weight * by_pose * by_pose.transpose();
        system.readout_mixed += weight * by_readout * by_pose;
        system.gradient += weight * residual * by_pose;
        system.readout_hessian += weight * by_readout * by_readout;
        system.readout_gradient += weight * by_readout * residual;
    }
}

}  // namespace roevo
