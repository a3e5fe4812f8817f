#include "tracking/tracker.h"

#include <Eigen/LU>
#include <cmath>

#include "stopwatch.h"
#include "tracking/camera_scale.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

// Frames of recordings that were tracked well agree to 72 % and more, poses that went astray to less than 40
constexpr double kLeastDepthAgreement = 0.4;
/// The last level of the image pyramid on which a pose is found that fine tracking takes over.
constexpr int kFinestCoarse = 1;
constexpr double kMatchedWithoutDepth = 0.6;  ///< share of the edges
// One sigma of poses that went astray
constexpr double kDoubtfulPosition = 0.15;  ///< m
constexpr double kDoubtfulTurn = 5 * kDegree;

std::string percent(double share) {
    return std::to_string(std::lround(100 * share)) + " %";
}

/// Why fine tracking failed.
Fault describeFailure(const FineResult& refined, const FineOptions& options) {
    if (refined.inliers < options.min_inliers)
        return {"only " + std::to_string(refined.inliers) + " associated edge points, " +
                std::to_string(options.min_inliers) + " needed"};
    if (refined.matched_ratio < options.min_matched_ratio)
        return {"only " + percent(refined.matched_ratio) + " of the edges associated, " +
                percent(options.min_matched_ratio) + " needed"};
    return {"the pose diverged"};
}

/// Of a coarse pose, from its residuals on the finest level. What they do not see is not known at all.
PoseUncertainty photometricUncertainty(const Keyframe& reference, const Frame& frame,
                                       const PinholeCamera& camera, const RowMotion& rows,
                                       const CoarseResult& aligned) {
    PhotometricTerm term;
    term.start(reference.photometric, 0, frame.pyramid.level(0), camera, aligned.brightness);
    DampingTerm unknown(kNothingKnown, kNothingKnown);
    PoseSystem system;
    const Linearisation at{aligned.T_current_keyframe, rows, 0};
    if (!term.linearise(at, system) || !unknown.linearise(at, system)) return {};
    EdgeClusters clusters;
    clusters.start(reference.clusters);
    term.addTo(clusters);
    return clusters.uncertainty(system, term.slope());
}

/// Rotations about the camera's x and y axes, up to 18 degrees each by 3: T_current_keyframe of each.
/// @param share_of_view  factor on these angles: the field of view as a share of a Kinect's
std::vector<Pose> searchAround(const Pose& T_keyframe_camera, double share_of_view) {
    const double step = 3 * kDegree * share_of_view;
    constexpr int kReach = 6;
    std::vector<Pose> guesses;
    for (int yaw = -kReach; yaw <= kReach; ++yaw) {
        for (int pitch = -kReach; pitch <= kReach; ++pitch) {
            Vector6d turn;
            turn << 0, 0, 0, pitch * step, yaw * step, 0;
            guesses.push_back(poseIncrement(turn) * T_keyframe_camera.inverse());
        }
    }
    return guesses;
}

}  // namespace

void Tracking::doubt() {
    doubtful = true;
    for (PoseUncertainty* one : {&pose.uncertainty, &measured}) {
        auto variances = one->independent.diagonal().array();
        variances.head<3>() += kDoubtfulPosition * kDoubtfulPosition;
        variances.tail<3>() += kDoubtfulTurn * kDoubtfulTurn;
    }
}

Tracker::Tracker(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      ideal_(camera.undistorted()),
      options_(scaledTo(camera, options)),
      coarse_(options_.coarse),
      fine_(camera, options_) {}

PhotometricPoints Tracker::choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                        const RowMotion&) const {
    return samplePhotometricPoints(edges, frame.pyramid, options_.coarse.max_points);
}

CoarseResult Tracker::align(const Keyframe& reference, const Frame& frame, const RollingShutter& shutter,
                            const std::vector<Pose>& guesses, const Brightness& brightness) {
    const int finest = options_.mode == Mode::kCoarse ? 0 : kFinestCoarse;
    return coarse_.track(reference, frame.pyramid, ideal_, shutter, guesses, brightness, finest);
}

FineResult Tracker::refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                           const PosePrior& prior, const RollingShutter& shutter,
                           const Brightness& brightness) {
    return fine_.track(reference, frame, T_start, prior, shutter, brightness);
}

Tracking Tracker::track(const Keyframe& reference, const Frame& frame, const Prediction& prediction) {
    return run(reference, frame, prediction,
               {prediction.T_reference_camera.inverse(), prediction.T_reference_last.inverse()},
               prediction.prior);
}

Tracking Tracker::trackFrom(const Keyframe& reference, const Frame& frame, const Prediction& prediction,
                            const Pose& T_keyframe_camera) {
    return run(reference, frame, prediction, {T_keyframe_camera.inverse()}, prediction.prior);
}

Tracking Tracker::search(const Keyframe& reference, const Frame& frame, const Prediction& prediction,
                         Tracking failed) {
    if (frame.edges.numEdges() == 0) return failed;
    const double share_of_view = ideal_.width / ideal_.fx / (640. / 525);
    Tracking found = run(reference, frame, prediction,
                         searchAround(prediction.T_reference_last, share_of_view), prediction.search_prior);
    if (found.tracked) std::swap(found, failed);
    failed.ms_coarse += found.ms_coarse;
    failed.ms_fine += found.ms_fine;
    failed.searched = true;
    if (failed.tracked) failed.fault = found.fault;
    return failed;
}

Tracking Tracker::run(const Keyframe& reference, const Frame& frame, const Prediction& prediction,
                      const std::vector<Pose>& guesses, const PosePrior& prior) {
    Tracking out;
    out.pose.keyframe = reference.id;
    RollingShutter shutter = prediction.shutter;
    // Two images in a row are sheared nearly alike: better both for still than one of them
    if (!reference.row_motion.known()) {
        shutter.readout_sigma = shutter.longReadout();
        shutter.rows.seconds_per_row = 0;
    }
    const Stopwatch coarse_watch;
    const CoarseResult aligned = align(reference, frame, shutter, guesses, prediction.brightness);
    out.ms_coarse = coarse_watch.milliseconds();
    out.brightness = aligned.brightness;
    const Stopwatch fine_watch;
    out.fault = options_.mode == Mode::kCoarse ? runCoarse(reference, frame, aligned, shutter, out)
                                               : runFine(reference, frame, aligned, prior, shutter, out);
    out.tracked = !out.fault;
    out.rows = prediction.shutter.motion(out.pose.T_keyframe_camera.inverse());
    out.ms_fine = fine_watch.milliseconds();
    return out;
}

Fault Tracker::runCoarse(const Keyframe& reference, const Frame& frame, const CoarseResult& aligned,
                         const RollingShutter& shutter, Tracking& out) {
    if (!aligned.converged)
        return {"coarse tracking saw too few points in the image: " + std::to_string(aligned.num_visible) +
                " of " + std::to_string(reference.photometric.size())};
    // Edges are associated only to know when the next keyframe is due
    const Pose& T = aligned.T_current_keyframe;
    fine_.associate(reference, frame, T, shutter.motion(T), options_.fine.final_radius);
    out.matches = fine_.matches();
    out.inliers = static_cast<int>(out.matches.size());
    if (out.matchedRatio() < options_.fine.min_matched_ratio / 2)
        return {"coarse tracking went astray: hardly any edge is where it should be"};
    out.pose.T_keyframe_camera = T.inverse();
    out.pose.uncertainty = photometricUncertainty(reference, frame, ideal_, shutter.motion(T), aligned);
    out.measured = out.pose.uncertainty;
    return out.pose.covariance().allFinite() ? Fault() : Fault{"the pose diverged"};
}

Fault Tracker::runFine(const Keyframe& reference, const Frame& frame, const CoarseResult& aligned,
                       const PosePrior& prior, const RollingShutter& shutter, Tracking& out) {
    const Pose T_start =
        fine_.chooseInitialPose(reference, frame, aligned.T_current_keyframe, prior.mean, shutter);
    const auto registered = [&] {
        const FineResult refined = refine(reference, frame, T_start, prior, shutter, aligned.brightness);
        const Pose& T = refined.T_current_keyframe;
        FineResult found = fine_.assess(reference, frame, T, shutter.motion(T));
        found.converged = found.converged && refined.converged;
        found.uncertainty = refined.uncertainty;
        found.of_velocity = refined.of_velocity;
        return found;
    };
    FineResult found = registered();
    Fault contradiction;
    if (found.converged && found.depth_agreement < kLeastDepthAgreement) {
        // Either the pose is wrong or the depth image. It is the depth where edges agree well all the same
        contradiction = {"the depth image contradicts the keyframe's: " + percent(found.depth_agreement) +
                         " of the points agree"};
        out.doubtful = found.matched_ratio < kMatchedWithoutDepth;
        if (!out.doubtful) {
            fine_.useDepth(false);
            found = registered();
            fine_.useDepth(true);
        }
    }
    out.matches = fine_.matches();
    out.inliers = found.inliers;
    out.found.assign(static_cast<std::size_t>(reference.edges.image.numEdges()), 0);
    for (std::size_t k = 0; k < out.matches.size(); ++k) {
        if (fine_.weights()[k] > 0)
            ++at(out.found, at(reference.edges.image.edge_of, out.matches.reference[k]));
    }
    if (!found.converged) return describeFailure(found, options_.fine);
    out.depth_fault = contradiction;
    out.pose.T_keyframe_camera = found.T_current_keyframe.inverse();
    out.pose.uncertainty = found.uncertainty;
    out.pose.uncertainty.independent += found.of_velocity;
    out.measured = found.uncertainty;
    out.measured.common.setZero();
    if (out.doubtful) out.doubt();
    return {};
}

void Tracker::learnReadout(const Keyframe& reference, const Frame& frame, const Tracking& tracking,
                           const RollingShutter& shutter, ReadoutEstimator& estimator) {
    if (options_.mode == Mode::kCoarse || !options_.sensor.estimate_readout || shutter.since_previous <= 0)
        return;
    fine_.addReadoutEvidence(reference, tracking.pose.T_keyframe_camera.inverse(), tracking.matches, shutter,
                             frame, estimator);
}

}  // namespace roevo
