#include "roevo/tracking/fine_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "roevo/edges/edge_depth.h"
#include "roevo/tracking/motion_blur.h"
#include "roevo/tracking/robust.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

constexpr double kOverRelaxation = 1.6;
/// Once the search radius is the final one, points keep what they were associated with until the image has
/// moved so far since, px: what they would be associated with instead lies on the same edge next to it.
constexpr double kKeptMotion = 0.1;
constexpr float kUnknown = -1;  ///< depth not looked up yet
constexpr double kFar = 1e9;    ///< px; further than any motion

}  // namespace

void FineTracker::project(const std::vector<float>& x, const std::vector<float>& y,
                          const std::vector<float>& z, const Pose& pose, const PinholeCamera& camera,
                          const RowMotion& rows) {
    const std::size_t padded = x.size();
    for (auto* array : {&x_, &y_, &z_, &u_, &v_}) array->resize(padded);
    kernels::best().project(makeProjection(pose, camera, rows), x.data(), y.data(), z.data(), padded,
                            {x_.data(), y_.data(), z_.data(), u_.data(), v_.data()});
}

void FineTracker::associate(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_current_keyframe,
                            const RowMotion& rows, double radius) {
    project(keyframe.edges.x, keyframe.edges.y, keyframe.edges.z, T_current_keyframe, *frame.camera, rows);
    associateProjected(keyframe, frame, T_current_keyframe, radius);
}

void FineTracker::associateProjected(const Keyframe& keyframe, const FineFrame& frame,
                                     const Pose& T_current_keyframe, double radius) {
    associator_.associate(keyframe.edges.image, u_.data(), v_.data(), imageRotation(T_current_keyframe),
                          edge_options_.tangent_span, *frame.edges, *frame.grid, frame.camera->width,
                          frame.camera->height, radius, matches_);
}

void FineTracker::geometricResiduals(const Keyframe& keyframe, const FineFrame& frame,
                                     const RowMotion& rows) {
    const OrganizedEdges& current = *frame.edges;
    const EdgePoints3D& edges = keyframe.edges;
    const MotionBlur now(rows, *frame.camera, sensor_.blur_time),
        then(keyframe.row_motion, *frame.camera, sensor_.blur_time);
    residual_.resize(matches_.size());
    sharpness_.resize(matches_.size());
    scratch_.clear();
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        // Eq. (7), as a signed scalar across the tangent (its square and normal equations are the same),
        // about the associated point rather than its predecessor: unbiased where the edge is curved
        residual_[k] =
            current.normal_x[p] * (u_[i] - current.x[p]) + current.normal_y[p] * (v_[i] - current.y[p]);
        const float blur = now.variance(x_[i], y_[i], z_[i], current.normal_x[p], current.normal_y[p]) +
                           then.variance(edges.x[i], edges.y[i], edges.z[i], edges.image.normal_x[i],
                                         edges.image.normal_y[i]);
        sharpness_[k] = 1 / (1 + blur);
        scratch_.push_back(std::abs(residual_[k]) * std::sqrt(sharpness_[k]));
    }
    if (!scratch_.empty()) scale_ = robustScale(scratch_);
}

float FineTracker::currentDepth(std::size_t point, const FineFrame& frame) {
    float& measured = current_depth_[point];
    if (measured != kUnknown) return measured;
    Eigen::Vector2d pixel(frame.edges->x[point], frame.edges->y[point]);
    if (frame.raw_camera->isDistorted()) pixel = frame.raw_camera->distortPixel(pixel);
    measured = foregroundDepth(*frame.depth, static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                               edge_options_, sensor_)
                   .depth;
    return measured;
}

void FineTracker::depthResiduals(const Keyframe& keyframe, const FineFrame& frame) {
    depth_residual_.assign(matches_.size(), 0);
    depth_weight_.assign(matches_.size(), 0);
    if (options_.depth_weight <= 0 || frame.depth->empty()) return;
    const auto chi2 = static_cast<float>(options_.depth_chi2);
    const auto noise2 = static_cast<float>(sensor_.depth_noise * sensor_.depth_noise);
    constexpr float kLeastVariance = 1e-6F;  // m^2: a millimetre, whatever the sensor
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const float measured = currentDepth(static_cast<std::size_t>(matches_.current[k]), frame);
        if (measured <= 0) continue;
        const float z2 = measured * measured, reference2 = keyframe.edges.z[i] * keyframe.edges.z[i];
        const float variance = noise2 * (z2 * z2 + reference2 * reference2) + kLeastVariance;
        // What the sides of the edge add in the keyframe they would add here, too
        const float residual = z_[i] - keyframe.edges.correction[i] - measured;
        const float squared = residual * residual / variance;
        if (squared > chi2) continue;
        depth_residual_[k] = residual;
        depth_weight_[k] =
            static_cast<float>(options_.depth_weight) / (variance * (1 + squared / kStudentNu));
    }
}

void FineTracker::weigh(const Keyframe& keyframe) {
    weight_.assign(matches_.size(), 0);
    inliers_ = 0;
    const auto inverse = static_cast<float>(1 / (scale_ * scale_));
    const auto chi2 = static_cast<float>(options_.chi2);
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const float information = sharpness_[k] * inverse;
        const float squared = residual_[k] * residual_[k] * information;
        if (squared > chi2) continue;
        ++inliers_;
        weight_[k] = studentWeight(
            keyframe.edges.weight[static_cast<std::size_t>(matches_.reference[k])] * information, squared);
    }
}

void FineTracker::accumulate(const PinholeCamera& camera, const OrganizedEdges& current, PoseSystem& system) {
    rows_.reset(matches_.size());
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        if (weight_[k] <= 0) continue;
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        const float nx = current.normal_x[p], ny = current.normal_y[p], w = weight_[k], r = residual_[k];
        float matrix[6], vector[3];
        liftInformation(x_[i], y_[i], z_[i], fx, fy, w * nx * nx, w * nx * ny, w * ny * ny, w * nx * r,
                        w * ny * r, matrix, vector);
        matrix[5] += depth_weight_[k];
        vector[2] += depth_weight_[k] * depth_residual_[k];
        rows_.set(k, matrix, vector, x_[i], y_[i], z_[i]);
    }
    system.add(rows_.sum());
}

void FineTracker::countHits(Keyframe& keyframe, const PinholeCamera& camera) const {
    keyframe.trials.resize(keyframe.edges.size(), 0);
    keyframe.hits.resize(keyframe.edges.size(), 0);
    constexpr float kMargin = 5;
    const float max_u = static_cast<float>(camera.width) - 1 - kMargin;
    const float max_v = static_cast<float>(camera.height) - 1 - kMargin;
    for (std::size_t i = associator_.firstLookedUp(); i < keyframe.edges.size(); i += associator_.stride()) {
        if (u_[i] >= kMargin && v_[i] >= kMargin && u_[i] <= max_u && v_[i] <= max_v) ++keyframe.trials[i];
    }
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        if (weight_[k] > 0) ++keyframe.hits[static_cast<std::size_t>(matches_.reference[k])];
    }
}

Pose FineTracker::betterStart(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_coarse,
                              const Pose& T_likely, const RollingShutter& shutter) {
    const Pose between = T_coarse.inverse() * T_likely;
    const double depth = std::max(keyframe.median_depth, 0.1);
    const double apart = frame.camera->fx * (rotationAngle(between) + between.translation().norm() / depth);
    if (apart < options_.final_radius) return T_coarse;
    std::size_t found[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        const Pose& pose = i == 0 ? T_coarse : T_likely;
        associate(keyframe, frame, pose, shutter.motion(pose), options_.final_radius);
        found[i] = matches_.size();
    }
    return found[1] > found[0] ? T_likely : T_coarse;
}

FineResult FineTracker::track(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_start,
                              const PosePrior& prior, const RollingShutter& shutter,
                              const Brightness& brightness) {
    const OrganizedEdges& current = *frame.edges;
    const PinholeCamera& camera = *frame.camera;
    const double depth = std::max(keyframe.median_depth, 0.1);
    current_depth_.assign(current.size(), kUnknown);
    Pose pose = T_start;
    Brightness gain = brightness;
    PoseSystem system;
    double moved_px = kFar;  // since points were associated within the final radius
    const double narrowing = std::clamp(options_.max_iterations - 1.0, 1.0, 4.0);
    for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
        const double share = std::min(1.0, iteration / narrowing);
        const double radius =
            options_.search_radius + share * (options_.final_radius - options_.search_radius);
        const RowMotion row_motion = shutter.motion(pose);
        if (share < 1 || moved_px > kKeptMotion) {
            associate(keyframe, frame, pose, row_motion, radius);
            moved_px = share < 1 ? kFar : 0;
        } else {
            project(keyframe.edges.x, keyframe.edges.y, keyframe.edges.z, pose, camera, row_motion);
        }
        if (static_cast<int>(matches_.size()) < options_.min_inliers) break;
        geometricResiduals(keyframe, frame, row_motion);
        depthResiduals(keyframe, frame);
        weigh(keyframe);
        system = PoseSystem();
        accumulate(camera, current, system);
        if (options_.photometric_weight > 0 && keyframe.photometric.size() > 0) {
            photometric_.evaluate(keyframe.photometric, 0, frame.pyramid->level(0), camera, pose, row_motion,
                                  gain);
            // alpha: both kinds of residual count as many points as the edges have, whatever the sample's
            // size
            const double count = static_cast<double>(matches_.size()) /
                                 std::max<double>(1, photometric_.numVisible() * kernels::kPatchSize);
            kernels::NormalEquations equations;
            photometric_.accumulate(keyframe.photometric, 0, camera, options_.photometric_weight * count,
                                    equations);
            system.add(equations);
            gain = photometric_.fitBrightness(keyframe.photometric, 0, gain);
        }
        system.addPrior(prior, pose, kCorrelatedPoints);
        // From the third step on, what remains is slow: associations and weights follow the pose. Longer
        // steps halve their number.
        const Vector6d step = (iteration < 2 ? 1 : kOverRelaxation) * system.solve();
        pose = poseIncrement(step) * pose;
        const double motion_px = camera.fx * (step.tail<3>().norm() + step.head<3>().norm() / depth);
        moved_px += motion_px;
        if (motion_px < 0.01 && share >= 1) break;
    }
    // What is reported belongs to the final pose
    FineResult result = assess(keyframe, frame, pose, shutter.motion(pose));
    if (result.converged) {
        result.covariance = kCorrelatedPoints * system.hessian.inverse();
    } else {
        result.T_current_keyframe = T_start;
    }
    return result;
}

FineResult FineTracker::assess(const Keyframe& keyframe, const FineFrame& frame,
                               const Pose& T_current_keyframe, const RowMotion& rows) {
    associate(keyframe, frame, T_current_keyframe, rows, options_.final_radius);
    geometricResiduals(keyframe, frame, rows);
    weigh(keyframe);
    FineResult result;
    result.T_current_keyframe = T_current_keyframe;
    const int matched = static_cast<int>(matches_.size());
    result.inliers = matched < options_.min_inliers ? matched : inliers_;
    result.scale = scale_;
    result.matched_ratio = matches_.matchedRatio();
    result.converged = result.inliers >= options_.min_inliers &&
                       result.matched_ratio >= options_.min_matched_ratio &&
                       T_current_keyframe.isFinite();
    return result;
}

}  // namespace roevo
