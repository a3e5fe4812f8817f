#include "tracking/fine_tracker.h"

#include <algorithm>

#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr int kPlainSteps = 2;        ///< without over-relaxation
constexpr int kPointsToChoose = 300;  ///< between two initial poses

// Of the read-out time
/// How much less the evidence of one frame counts: its velocity is only known from two poses.
constexpr double kCaution = 100;
/// Share of what is known that a frame must add to be worth its time.
constexpr double kLeastWorth = 0.01;
constexpr int kReadoutSteps = 3;
constexpr double kFreedom = 0.005;  ///< s, one sigma, of the read-out time in these steps

/// Keeps the read-out time of one frame about where it was.
class ReadoutPriorTerm : public ResidualTerm {
  public:
    ReadoutPriorTerm(double mean, double sigma) : mean_(mean), information_(1 / (sigma * sigma)) {}
    bool linearise(const Linearisation& at, PoseSystem& system) override {
        system.hessian.diagonal().array() += kCaution * 1e-6;
        system.readout_hessian += information_;
        system.readout_gradient += information_ * (at.rows.seconds_per_row - mean_);
        return true;
    }

  private:
    double mean_, information_;
};

}  // namespace

void FineTracker::associate(const Keyframe& keyframe, const Frame& frame, const Pose& T_current_keyframe,
                            const RowMotion& rows, double radius) {
    edges_.look(keyframe, frame);
    edges_.associate(T_current_keyframe, rows, radius);
}

Pose FineTracker::chooseInitialPose(const Keyframe& keyframe, const Frame& frame, const Pose& T_coarse,
                                    const Pose& T_likely, const RollingShutter& shutter) {
    if (imageMotion(T_coarse, T_likely, ideal_.fx, keyframe.typicalDepth()) < options_.final_radius)
        return T_coarse;
    edges_.look(keyframe, frame);
    edges_.limit(std::min(kPointsToChoose, options_.max_points));
    const auto found = [&](const Pose& pose) {
        edges_.associate(pose, shutter.motion(pose), options_.final_radius);
        return matches().size();
    };
    const std::size_t by_coarse = found(T_coarse);
    return found(T_likely) > by_coarse ? T_likely : T_coarse;
}

FineResult FineTracker::track(const Keyframe& keyframe, const Frame& frame, const Pose& T_start,
                              const PosePrior& prior, const RollingShutter& shutter,
                              const Brightness& brightness) {
    edges_.start(keyframe, frame);
    photometric_.start(keyframe.photometric, 0, frame.pyramid.level(0), ideal_, brightness);
    // alpha: both kinds of residual count as many points as the edges have, whatever the sample's size
    photometric_.balance(options_.photometric_weight, [this] { return edges_.matches().size(); });
    PriorTerm likely(prior);
    std::vector<ResidualTerm*> terms{&edges_, &likely};
    if (options_.photometric_weight > 0 && keyframe.photometric.size() > 0) terms.push_back(&photometric_);
    GaussNewtonOptions loop{options_.max_iterations, ideal_.fx, keyframe.typicalDepth()};
    loop.settled_from = edges_.narrowed();
    loop.relaxation = kOverRelaxation;
    loop.relaxed_from = kPlainSteps;
    const GaussNewtonResult found = minimise(T_start, shutter, terms, loop);
    FineResult result;
    result.T_current_keyframe = found.T_current_keyframe;
    result.iterations = found.iterations;
    if (found.complete) {
        clusters_.start(keyframe.clusters);
        for (const ResidualTerm* term : terms) term->addTo(clusters_);
        result.uncertainty = clusters_.uncertainty(found.system, edges_.slope(), &likely);
        if (const double longest = shutter.longReadout(); longest > 0) {
            const RowMotion rows = shutter.motion(found.T_current_keyframe), &then = keyframe.row_motion;
            const Matrix6d moved = edges_.movedByVelocity(rows.at(longest), likely.information());
            const Matrix6d of_guess = moved * shutter.velocity_variance.asDiagonal() * moved.transpose();
            const double share = shutter.rows.seconds_per_row / longest;
            result.of_velocity = share * share * of_guess;
            // What moved alike looks alike, however long it takes to read
            const Eigen::Matrix3d R = found.T_current_keyframe.linear();
            Vector6d faster;
            faster << rows.velocity - R * then.velocity, rows.turn - R * then.turn;
            const Vector6d longer = shutter.readout_sigma / longest * moved * faster;
            result.uncertainty.common = then.known() ? Matrix6d(longer * longer.transpose()) : of_guess;
        }
    }
    result.converged =
        found.complete && found.T_current_keyframe.isFinite() && result.uncertainty.covariance().allFinite();
    if (!found.T_current_keyframe.isFinite()) result.T_current_keyframe = T_start;
    return result;
}

FineResult FineTracker::assess(const Keyframe& keyframe, const Frame& frame, const Pose& T_current_keyframe,
                               const RowMotion& rows) {
    edges_.look(keyframe, frame);
    edges_.assess(T_current_keyframe, rows);
    FineResult result;
    result.depth_agreement = edges_.depthAgreement();
    result.T_current_keyframe = T_current_keyframe;
    const int matched = static_cast<int>(matches().size());
    result.inliers = matched < options_.min_inliers ? matched : edges_.inliers();
    result.matched_ratio = matches().matchedRatio();
    result.converged = result.inliers >= options_.min_inliers &&
                       result.matched_ratio >= options_.min_matched_ratio && T_current_keyframe.isFinite();
    return result;
}

void FineTracker::addReadoutEvidence(const Keyframe& keyframe, const Pose& T_current_keyframe,
                                     const EdgeMatches& matches, const RollingShutter& shutter,
                                     const Frame& frame, ReadoutEstimator& estimator) {
    edges_.startReadout(keyframe, frame, matches);
    ReadoutPriorTerm about(shutter.rows.seconds_per_row, kFreedom / ideal_.height);
    const auto linearisedAt = [&](const Pose& pose, const RollingShutter& rows, PoseSystem& system) {
        system.hessian.diagonal().array() += kCaution * 1e-6;
        return edges_.linearise({pose, rows.motion(pose), 0}, system);
    };
    PoseSystem first;
    if (!linearisedAt(T_current_keyframe, shutter, first)) return;
    if (estimator.worth(first / kCaution) < kLeastWorth) return;
    // Those that followed the pose lack more of it (fr1_rpy backwards in tr: 0.59 cm with them, 0.53)
    edges_.renewMatches(T_current_keyframe, shutter.motion(T_current_keyframe));
    GaussNewtonOptions loop{kReadoutSteps, ideal_.fx, keyframe.typicalDepth()};
    loop.relaxation = kOverRelaxation;
    loop.free_readout = true;
    const GaussNewtonResult found = minimise(T_current_keyframe, shutter, {&edges_, &about}, loop);
    RollingShutter learned = shutter;
    learned.rows.seconds_per_row = found.seconds_per_row;
    PoseSystem last;
    if (!found.complete || !linearisedAt(found.T_current_keyframe, learned, last)) return;
    // As they would be with no read-out time
    last.gradient -= last.readout_mixed * learned.rows.seconds_per_row;
    last.readout_gradient -= last.readout_hessian * learned.rows.seconds_per_row;
    estimator.add(last / kCaution, kFrameRate * shutter.since_previous);
}

}  // namespace roevo
