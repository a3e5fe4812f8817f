#include "tracking/edge_term.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "tracking/motion_blur.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

/// Points stay with the edges that they were associated with until the image has moved so far since, px: what
/// is nearer then lies on the same edge.
constexpr double kSameEdges = 1.5;
constexpr double kNarrowing = 2;    ///< iterations in which the radius narrows down
constexpr int kFirstPoints = 1600;  ///< looked up as it does
/// Neighbours along an edge look at much the same pixels of the depth image: every n-th speaks for all.
constexpr std::size_t kDepthStride = 6;
constexpr std::size_t kTellingDepths = 20;  ///< fewer, as a scrap at an outline has, contradict nothing
constexpr float kUnknown = -1;              ///< depth not looked up yet

}  // namespace

EdgeTerm::EdgeTerm(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      ideal_(camera.undistorted()),
      options_(options.fine),
      edge_options_(options.edges),
      sensor_(options.sensor),
      associator_(ideal_, options.fine, options.edges.tangent_span) {}

void EdgeTerm::look(const Keyframe& keyframe, const Frame& frame) {
    const bool is_other =
        frame_ != &frame || looked_at_ != frame.timestamp() || current_depth_.size() != frame.edges.size();
    if (is_other) {
        current_depth_.assign(frame.edges.size(), kUnknown);
        foreground_ = ForegroundDepth(frame.images.depth, edge_options_, sensor_);
    }
    if (is_other || keyframe_ != &keyframe) associated_within_ = 0;
    looked_at_ = frame.timestamp();
    keyframe_ = &keyframe;
    frame_ = &frame;
    free_readout_ = false;
    associator_.limit(options_.max_points);
}

void EdgeTerm::start(const Keyframe& keyframe, const Frame& frame) {
    frame_ = nullptr;  // whatever was looked up is another frame's
    look(keyframe, frame);
}

void EdgeTerm::startReadout(const Keyframe& keyframe, const Frame& frame, const EdgeMatches& matches) {
    look(keyframe, frame);
    associated_within_ = 0;  // these matches are another's
    free_readout_ = true;
    matches_ = matches;
    gather();
}

int EdgeTerm::narrowed() const {
    return static_cast<int>(std::clamp(options_.max_iterations - 1.0, 1.0, kNarrowing));
}

bool EdgeTerm::linearise(const Linearisation& at, PoseSystem& system) {
    const double share = std::min(1.0, static_cast<double>(at.iteration) / narrowed());
    const double radius = options_.search_radius + share * (options_.final_radius - options_.search_radius);
    if (free_readout_ || isAssociated(at.T_current_keyframe, radius)) {
        projectMatched(at.T_current_keyframe, at.rows);
        follow();
    } else {
        const bool goes_on = at.iteration < narrowed() && narrowed() < options_.max_iterations;
        associator_.limit(std::min(options_.max_points, goes_on ? kFirstPoints : options_.max_points));
        associate(at.T_current_keyframe, at.rows, radius);
        gather();
        projectMatched(at.T_current_keyframe, at.rows);
        T_associated_ = at.T_current_keyframe;
        associated_within_ = radius;
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

/// Edges are, within a radius of at most that, and their points may follow them to this pose.
bool EdgeTerm::isAssociated(const Pose& T_current_keyframe, double radius) const {
    return associated_within_ > 0 && associated_within_ <= radius &&
           imageMotion(T_associated_, T_current_keyframe, ideal_.fx, keyframe_->typicalDepth()) < kSameEdges;
}

void EdgeTerm::associate(const Pose& T_current_keyframe, const RowMotion& rows, double radius) {
    associated_within_ = 0;
    project(keyframe_->edges.points, T_current_keyframe, ideal_, rows, projected_);
    associator_.associate(keyframe_->edges.image, projected_, T_current_keyframe, frame_->edges, frame_->grid,
                          radius, matches_);
}

void EdgeTerm::renewMatches(const Pose& T_current_keyframe, const RowMotion& rows) {
    associate(T_current_keyframe, rows, options_.final_radius);
    gather();
}

void EdgeTerm::assess(const Pose& T_current_keyframe, const RowMotion& rows) {
    const bool all = associator_.stride() == strideFor(keyframe_->edges.size(), options_.max_points);
    const bool follows = all && isAssociated(T_current_keyframe, options_.final_radius);
    if (!follows) renewMatches(T_current_keyframe, rows);
    projectMatched(T_current_keyframe, rows);
    if (follows) follow();
    tangentResiduals(rows);
    weigh();
}

/// Collects what there is of the matches.
void EdgeTerm::gather() {
    const EdgePoints3D& edges = keyframe_->edges;
    const std::size_t n = matches_.size(), padded = kernels::paddedSize(n);
    matched_.reference = matches_.reference;
    matched_.current = matches_.current;
    matched_.reference.resize(padded, n > 0 ? matches_.reference.front() : 0);
    matched_.current.resize(padded, n > 0 ? matches_.current.front() : 0);
    const auto& kernels = kernels::best();
    const auto pick = [&](const std::vector<float>& values, std::vector<float>& out) {
        out.resize(padded);
        kernels.pick(values.data(), matched_.reference.data(), padded, out.data());
    };
    pick(edges.points.x, matched_.points.x);
    pick(edges.points.y, matched_.points.y);
    pick(edges.points.z, matched_.points.z);
    pick(edges.image.y, matched_.row);
    pick(edges.weight, matched_.weight);
    std::fill(matched_.weight.begin() + static_cast<std::ptrdiff_t>(n), matched_.weight.end(), 0.0F);
    pick(edges.correction, matched_.correction);
    pick(edges.image.normal_x, residual_);  // buffers
    pick(edges.image.normal_y, sharpness_);
    matched_.blur.resize(padded);
    kernels.blur(cameraMotion(keyframe_->row_motion, ideal_, sensor_.blur_time), matched_.points.x.data(),
                 matched_.points.y.data(), matched_.points.z.data(), residual_.data(), sharpness_.data(),
                 padded, matched_.blur.data());
}

void EdgeTerm::projectMatched(const Pose& pose, const RowMotion& rows) {
    const RowMotion& then = keyframe_->row_motion;
    const bool moves = free_readout_ && rows.seconds_per_row != then.seconds_per_row;
    if (moves) {
        moved_ = matched_.points;
        exchangeMotion(then, then.at(rows.seconds_per_row), matched_.row, matches_.size(), moved_);
    }
    project(moves ? moved_ : matched_.points, pose, ideal_, rows, matched_.projected);
}

/// After a small motion: each match moves along its edge to the point that is nearest now.
void EdgeTerm::follow() {
    kernels::best().follow(matched_.projected.u.data(), matched_.projected.v.data(), imageEdges(),
                           matched_.current.size(), matched_.current.data());
    std::copy_n(matched_.current.begin(), matches_.size(), matches_.current.begin());
}

kernels::MatchedPoints EdgeTerm::matchedPoints() const {
    const ProjectedPoints3& p = matched_.projected;
    return {p.x.data(), p.y.data(), p.z.data(), p.u.data(), p.v.data(), matched_.current.data()};
}

kernels::ImageEdges EdgeTerm::imageEdges() const {
    const OrganizedEdges& edges = frame_->edges;
    return {edges.x.data(),        edges.y.data(),       edges.normal_x.data(),
            edges.normal_y.data(), edges.edge_of.data(), edges.begin.data()};
}

void EdgeTerm::tangentResiduals(const RowMotion& rows) {
    const std::size_t padded = matched_.current.size();
    for (auto* array : {&residual_, &sharpness_, &scratch_}) array->resize(padded);
    if (padded == 0) return;
    kernels::best().edgeResiduals(matchedPoints(), imageEdges(),
                                  cameraMotion(rows, ideal_, sensor_.blur_time), matched_.blur.data(), padded,
                                  residual_.data(), sharpness_.data(), scratch_.data());
    scratch_.resize(matches_.size());
    scale_ = robustScale(scratch_);
}

double EdgeTerm::depthAgreement() {
    int known = 0, agreed = 0;
    if (!use_depth_ || frame_->images.depth.empty()) return 1;
    const std::size_t stride = matches_.size() < kTellingDepths * kDepthStride ? 1 : kDepthStride;
    for (std::size_t k = 0; k < matches_.size(); k += stride) {
        if (weight_[k] <= 0) continue;
        const double seen = currentDepth(static_cast<std::size_t>(matches_.current[k]));
        if (seen <= 0) continue;
        ++known;
        if (depthsAgree(matched_.projected.z[k], seen, sensor_)) ++agreed;
    }
    return known >= static_cast<int>(kTellingDepths) ? static_cast<double>(agreed) / known : 1;
}

Matrix6d EdgeTerm::movedByVelocity(const RowMotion& rows, const Matrix6d& prior_information) {
    PoseSystem system, times_time;
    system.hessian = prior_information;
    system.add(rows_.sum());
    scratch_.resize(matched_.projected.v.size());
    for (std::size_t i = 0; i < scratch_.size(); ++i)
        scratch_[i] =
            static_cast<float>(rows.seconds_per_row * (matched_.projected.v[i] - rows.reference_row));
    rows_.scale(scratch_);
    times_time.add(rows_.sum());
    return system.hessian.ldlt().solve(times_time.hessian);
}

float EdgeTerm::currentDepth(std::size_t point) {
    float& measured = current_depth_[point];
    if (measured != kUnknown) return measured;
    const Eigen::Vector2d pixel = camera_.distortPixel({frame_->edges.x[point], frame_->edges.y[point]});
    measured = foreground_.at(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    return measured;
}

void EdgeTerm::depthResiduals() {
    depth_residual_.assign(matched_.current.size(), 0);
    depth_weight_.assign(matched_.current.size(), 0);
    if (!use_depth_ || options_.depth_weight <= 0 || frame_->images.depth.empty()) return;
    const auto chi2 = static_cast<float>(options_.depth_chi2);
    const auto floor2 = static_cast<float>(sensor_.depth_noise_floor * sensor_.depth_noise_floor);
    const auto noise2 = static_cast<float>(sensor_.depth_noise * sensor_.depth_noise);
    const auto weight = static_cast<float>(options_.depth_weight * kDepthStride);
    for (std::size_t k = 0; k < matches_.size(); k += kDepthStride) {
        const float measured = currentDepth(static_cast<std::size_t>(matches_.current[k]));
        if (measured <= 0) continue;
        const float z2 = measured * measured, then = matched_.points.z[k], reference2 = then * then;
        const float variance = noise2 * (z2 * z2 + reference2 * reference2) + 2 * floor2;
        // What the sides of the edge add in the keyframe they would add here, too
        const float residual = matched_.projected.z[k] - matched_.correction[k] - measured;
        const float squared = residual * residual / variance;
        if (squared > chi2) continue;
        depth_residual_[k] = residual;
        // Not by its sharpness: the depth of a surface does not blur as its edge moves (weighed by it,
        // fr1_rpy lost a fifth)
        depth_weight_[k] = studentWeight(weight * matched_.weight[k] / variance, squared);
    }
}

void EdgeTerm::weigh() {
    weight_.resize(matched_.current.size());
    kernels::Fit fit;
    inliers_ = kernels::best().weighEdges(residual_.data(), sharpness_.data(), matched_.weight.data(),
                                          weight_.size(), static_cast<float>(1 / (scale_ * scale_)),
                                          static_cast<float>(options_.chi2), weight_.data(), fit);
    slope_ = meanSlope(fit.slopes, fit.weights);
}

void EdgeTerm::accumulate(PoseSystem& system) {
    kernels::best().liftEdges(matchedPoints(), imageEdges(), weight_.data(), residual_.data(),
                              depth_weight_.data(), depth_residual_.data(), weight_.size(),
                              static_cast<float>(ideal_.fx), static_cast<float>(ideal_.fy),
                              rows_.arrays(matches_.size()));
    system.add(rows_.sum());
}

void EdgeTerm::addTo(EdgeClusters& clusters) const {
    rows_.addTo(clusters, matches_.size(),
                [&](std::size_t k) { return at(keyframe_->edges.image.edge_of, matches_.reference[k]); });
}

void EdgeTerm::accumulateReadout(const Linearisation& at, PoseSystem& system) {
    const RowMotion& then = keyframe_->row_motion;
    const Eigen::Matrix3d R = at.T_current_keyframe.linear();
    const Eigen::Vector3d velocity = R * then.velocity;
    const Eigen::Matrix3d turn = R * skew(then.turn);
    kernels::ReadoutPoints readout{matched_.points.x.data(),
                                   matched_.points.y.data(),
                                   matched_.points.z.data(),
                                   matched_.row.data(),
                                   {},
                                   {},
                                   static_cast<float>(at.rows.reference_row)};
    for (int r = 0; r < 3; ++r) {
        readout.velocity[r] = static_cast<float>(velocity[r]);
        for (int c = 0; c < 3; ++c) readout.turn[3 * r + c] = static_cast<float>(turn(r, c));
    }
    kernels::ReadoutSums sums;
    kernels::best().liftReadout(matchedPoints(), imageEdges(),
                                cameraMotion(at.rows, ideal_, sensor_.blur_time), readout, weight_.data(),
                                residual_.data(), weight_.size(), static_cast<float>(ideal_.fx),
                                static_cast<float>(ideal_.fy), rows_.arrays(matches_.size()), sums);
    system.add(rows_.sum());
    system.readout_mixed += Eigen::Map<const Vector6d>(sums.mixed);
    system.readout_hessian += sums.own;
    system.readout_gradient += sums.gradient;
}

}  // namespace roevo
