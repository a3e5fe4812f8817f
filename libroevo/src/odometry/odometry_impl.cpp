#include "odometry_impl.h"

#include <algorithm>
#include <utility>

#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr std::size_t kTrackedBack = 10;  // lost frames that are kept: images and all
/// Where fewer edges are matched, a search may find a pose that matches clearly more: so many times.
constexpr double kFewMatched = 0.5, kClearlyMore = 1.2;

}  // namespace

/// The paper's pipeline figure.
FrameResult Odometry::Impl::processFrame(PreparedFrame::Content prepared) {  // Sec. IV
    if (prepared.fault) return rejected(prepared.timestamp, prepared.fault);
    if (prepared.timestamp <= last_timestamp) return rejected(prepared.timestamp, {kTimeBackward});
    edges_ms = prepared.milliseconds;
    if (isFrozen(*prepared.frame)) return report(frozen(std::move(prepared.frame)));
    take(std::move(prepared.frame));
    if (world.empty()) return report(start());
    Outcome outcome;
    Prediction prediction = motion.predict(frame->timestamp());
    outcome.tracking = track(prediction);  // Sec. V
    if (outcome.tracking.lost()) trackFromNearer(outcome, prediction);
    if (outcome.tracking.lost()) return report(findAgain(std::move(outcome), prediction.since_measured));

    lost_frames = 0;
    learn(outcome.tracking, prediction);
    if (!lost.empty()) trackBack(outcome.tracking);
    if (!keyframeIsDue(world.reference(), outcome.tracking, options.keyframe))
        lookForOtherTrack(outcome);
    else if (!returnToFormer(outcome))
        renewReference(outcome);  // Sec. VI
    // A tracked pose is what the next one is predicted from
    motion.measure(frame->timestamp(), outcome.tracking.pose.T_keyframe_camera, outcome.tracking.measured);
    if (outcome.is_keyframe) motion.becomeReference();
    FrameResult result = report(outcome);
    if (!outcome.is_keyframe) candidate = std::move(outcome.tracking);
    return result;
}

void Odometry::Impl::expect(double timestamp) {
    last_timestamp = timestamp;
    motion.expect(timestamp);
    world.advance(timestamp, motion.secondsPerRow());
}

void Odometry::Impl::take(std::unique_ptr<Frame> fresh) {
    is_frozen = false;
    expect(fresh->timestamp());
    auto before = std::exchange(frame, std::move(fresh));
    if (lost_frames == 0) return preparer.giveBack(std::exchange(frame_before, std::move(before)));
    lost.push_back(std::move(before));
    if (lost.size() > kTrackedBack) lost.erase(lost.begin());
}

Tracking Odometry::Impl::track(const Prediction& prediction) {
    Tracking tracking = tracker->track(world.reference(), *frame, prediction);
    if (tracking.lost())
        tracking = tracker->search(world.reference(), *frame, prediction, std::move(tracking));
    else if (tracking.matchedRatio() < kFewMatched && options.loss.recognise) {
        Tracking better = searchBetter(tracking, prediction);
        if (better.tracked) return better;
        tracking.ms_coarse = better.ms_coarse;
        tracking.ms_fine = better.ms_fine;
    }
    const bool in_doubt = prediction.blind || tracking.searched || tracking.doubtful;
    if (tracking.tracked && in_doubt && options.loss.recognise)
        tracking = confirmed(world.reference(), std::move(tracking), prediction);
    return tracking;
}

/// Another pose that matches clearly more edges, if there is one.
Tracking Odometry::Impl::searchBetter(const Tracking& tracking, const Prediction& prediction) {
    Tracking found = tracker->search(world.reference(), *frame, prediction, tracking);
    const Fault few{"only " + std::to_string(static_cast<int>(100 * tracking.matchedRatio())) +
                    " % of the edges associated, " + std::to_string(static_cast<int>(100 * kFewMatched)) +
                    " % needed"};
    if (found.matchedRatio() <= kClearlyMore * tracking.matchedRatio()) found.reject(few);
    if (found.lost()) return found;
    found.fault = few;
    return confirmed(world.reference(), std::move(found), prediction);
}

/// Whether a camera that moves shows the same image once more. One at rest may, where nothing makes noise.
bool Odometry::Impl::isFrozen(const Frame& fresh) {
    constexpr double kAtRest = 0.5;  // px of image motion
    if (!measured || !sameBytes(fresh.images.grey, frame->images.grey)) return false;
    if (is_frozen) return true;
    const Prediction prediction = motion.predict(fresh.timestamp());
    return imageMotion(prediction.T_reference_camera.inverse(), prediction.T_reference_last.inverse(),
                       camera.fx, world.reference().typicalDepth()) > kAtRest;
}

/// What the camera has seen before tells nothing of where it is now, and is not tracked: it would be taken
/// for standing still.
Outcome Odometry::Impl::frozen(std::unique_ptr<Frame> fresh) {
    is_frozen = true;
    const double timestamp = fresh->timestamp();
    preparer.giveBack(std::move(fresh));
    expect(timestamp);
    const Prediction prediction = motion.predict(timestamp);
    Outcome outcome;
    outcome.status = FrameStatus::kPredicted;
    outcome.tracking.fault = {
        "the image is the same as the one before it: a frozen camera, or one at rest without noise"};
    outcome.tracking.pose = {world.reference().id, prediction.T_reference_camera, prediction.prior.errors};
    return outcome;
}

Outcome Odometry::Impl::start() {
    if (world.loaded() > 0) {
        const auto pose = world.find(*frame, {}, 0);
        if (auto found = pose ? anchorAt(*pose, {}) : std::nullopt) {
            found->status = FrameStatus::kInitialised;
            return *found;
        }
    }
    Outcome outcome;
    outcome.tracking.fault = beginTrack(T_world_start, Matrix6d::Zero(), 0, outcome);
    if (outcome.tracking.fault) outcome.status = FrameStatus::kRejected;
    return outcome;
}

/// Every keyframe adds its own error to all that follow. Where an older one shows about the same, the frame
/// is tracked against that, which becomes the reference again.
bool Odometry::Impl::returnToFormer(Outcome& outcome) {
    Tracking& tracking = outcome.tracking;
    Pose T_former_camera;
    const Keyframe* former = world.nearest(tracking.pose, T_former_camera);
    if (former == nullptr || tracking.doubtful || tracking.depth_fault) return false;
    MotionModel from_there = motion;
    from_there.changeReference(T_former_camera * tracking.pose.T_keyframe_camera.inverse());
    Prediction prediction = from_there.predict(frame->timestamp());
    if (prediction.blind) return false;
    prediction.prior = prediction.search_prior;  // the camera may have drifted since
    prediction.brightness = {};
    Tracking again = tracker->trackFrom(*former, *frame, prediction, T_former_camera);
    tracking.ms_coarse = again.ms_coarse += tracking.ms_coarse;
    tracking.ms_fine = again.ms_fine += tracking.ms_fine;
    if (again.lost() || again.doubtful || again.depth_fault ||
        keyframeIsDue(*former, again, options.keyframe))
        return false;
    motion.changeReference(again.pose.T_keyframe_camera * tracking.pose.T_keyframe_camera.inverse());
    motion.setBrightness(again.brightness);
    candidate.reset();
    world.returnTo(tracking.pose, again.pose);
    again.searched = tracking.searched;
    again.fault = tracking.fault;
    tracking = std::move(again);
    return true;
}

/// @param outcome  with the frame's tracking, which is relative to the new reference in the end
void Odometry::Impl::renewReference(Outcome& outcome) {
    Tracking& tracking = outcome.tracking;
    // A frame that suddenly sees less is often a blurred one, and a bad keyframe. The frame before it was
    // still tracked well: it takes over, and this frame is tracked once more, from nearer by.
    const bool sees_less = tracking.matchedRatio() < options.keyframe.min_overlap;
    const bool takes_over = sees_less && candidate && candidate->matchedRatio() > tracking.matchedRatio();
    const RelativePose promoted = takes_over ? candidate->pose : tracking.pose;
    outcome.no_keyframe = takes_over ? promote(*frame_before, *candidate) : promote(*frame, tracking);
    if (outcome.no_keyframe) return;
    outcome.new_keyframe = true;
    tracking.pose = changeReference(tracking.pose, promoted, world.reference().id);
    outcome.is_keyframe = !takes_over;
    if (outcome.is_keyframe) {
        tracking.pose.uncertainty = {};
        return;
    }
    motion.becomeReference();  // the frame before
    const Prediction prediction = motion.predict(frame->timestamp());
    Tracking again =
        tracker->trackFrom(world.reference(), *frame, prediction, tracking.pose.T_keyframe_camera);
    again.ms_coarse += tracking.ms_coarse;
    again.ms_fine += tracking.ms_fine;
    if (!again.tracked) {
        // What is seen from afar should be seen from nearby
        outcome.not_from_newest = again.fault;
        tracking.measured = tracking.pose.uncertainty;
        tracking.doubt();
        tracking.matches = {};  // with another keyframe
        tracking.inliers = 0;
        return;
    }
    learn(again, prediction);
    again.searched = tracking.searched;
    again.fault = tracking.fault;
    tracking = std::move(again);
}

/// A frame that shows where another track was becomes a keyframe, so that they can be joined.
void Odometry::Impl::lookForOtherTrack(Outcome& outcome) {
    const Tracking& tracking = outcome.tracking;
    if (tracking.doubtful || tracking.depth_fault) return;  // nothing is joined by those
    if (!world.lookForOtherTrack(*frame, tracking.pose)) return;
    renewReference(outcome);
    outcome.no_keyframe = {};  // none was due
}

/// What a tracked frame tells besides its pose, and what a gap before it leaves unknown.
void Odometry::Impl::learn(Tracking& tracking, const Prediction& prediction) {
    motion.setBrightness(tracking.brightness);
    auto& reference = world.reference();
    reference.count(tracking.matches.visible, tracking.found);
    if (prediction.blind) {
        // The mean velocity of a gap says nothing of how the camera moves at its ends. What is `measured`
        // stays: it is meant for known rows, and the next velocity is made of it
        tracking.rows = motion.stillRows();
        addErrorsFromElsewhere(tracking.pose.uncertainty);
    } else if (!reference.row_motion.known()) {
        reference.setRowMotion(
            motion.firstRows(frame->timestamp() - reference.timestamp, tracking.pose.T_keyframe_camera));
    } else {
        tracker->learnReadout(reference, *frame, tracking, prediction.shutter, motion.readout());
    }
}

/// @param outcome  of the frame, which is the reference now, if it can be
Fault Odometry::Impl::beginTrack(const Pose& T_world_camera, const Matrix6d& covariance, double lost_for,
                                 Outcome& outcome) {
    const Fault fault = world.beginTrack(*frame, motion.stillRows(), T_world_camera, covariance, lost_for);
    if (fault) return fault;
    motion.anchor(frame->timestamp(), Pose::Identity());
    candidate.reset();
    lost_frames = 0;
    outcome.status = FrameStatus::kInitialised;
    outcome.tracking.pose = {world.reference().id, Pose::Identity(), {}};
    outcome.new_keyframe = true;
    return {};
}

Fault Odometry::Impl::promote(const Frame& promoted, const Tracking& tracked) {
    if (tracked.depth_fault && !tracked.doubtful) return tracked.depth_fault;
    if (const Fault fault = world.addKeyframe(promoted, tracked)) return fault;
    motion.changeReference(tracked.pose.T_keyframe_camera.inverse());
    candidate.reset();  // which `tracked` may be
    return {};
}

FrameResult Odometry::Impl::report(const Outcome& outcome) {
    const Tracking& tracking = outcome.tracking;
    FrameResult result = world.changes();
    result.timestamp = last_timestamp;
    result.status = outcome.status;
    result.num_edges = frame->edges.numEdges();
    result.num_points = static_cast<int>(frame->edges.size());
    result.ms.edges = edges_ms;
    if (outcome.status == FrameStatus::kRejected) {
        result.reason = "cannot start here: " + tracking.fault.words;
        return result;
    }
    const bool is_measured = outcome.hasMeasuredPose();
    // A frozen frame leaves the one before it as the last that was looked at
    if (!is_frozen) measured = is_measured;
    world.addFrame(result.timestamp, tracking.pose, is_measured);
    result.index = static_cast<int>(world.trajectory().live().size()) - 1;
    result.keyframe = tracking.pose.keyframe;
    result.T_world_camera = world.trajectory().worldPose(tracking.pose);
    result.covariance = world.covariance(tracking.pose);
    const bool is_first = world.isLocalised() && !std::exchange(localised, true);
    result.reason = describe(outcome, result, is_first ? world.loaded() : 0);
    result.new_keyframe = outcome.new_keyframe;
    result.found_at = outcome.found_at;
    result.matched_ratio = tracking.matchedRatio();
    result.inliers = tracking.inliers;
    result.ms.coarse = tracking.ms_coarse;
    result.ms.fine = tracking.ms_fine;
    return result;
}

}  // namespace roevo
