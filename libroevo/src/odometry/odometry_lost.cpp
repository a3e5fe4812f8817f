// What becomes of frames that tracking loses, or is in doubt of.
#include <algorithm>
#include <utility>

#include "odometry_impl.h"
#include "tracking/se3.h"

namespace roevo {

/// Where the reference does not lead to this frame, the one before may, which was still tracked: it becomes
/// the reference.
void Odometry::Impl::trackFromNearer(Outcome& outcome, Prediction& prediction) {
    if (!candidate || frame->edges.numEdges() == 0 || promote(*frame_before, *candidate)) return;
    outcome.new_keyframe = true;
    motion.becomeReference();
    prediction = motion.predict(frame->timestamp());
    Tracking nearer = track(prediction);
    nearer.ms_coarse += outcome.tracking.ms_coarse;
    nearer.ms_fine += outcome.tracking.ms_fine;
    outcome.tracking = std::move(nearer);
}

/// After a gap in time, and to a search, any pose may look right, and one whose depths contradict may be
/// wrong: the edges must agree without what is likely.
Tracking Odometry::Impl::confirmed(const Keyframe& keyframe, Tracking tracking,
                                   const Prediction& prediction) {
    const std::string gap =
        std::to_string(static_cast<int>(std::min(1e3 * prediction.since_measured, 2e9))) + " ms";
    // The mean velocity of a gap is not that of its end, and where the keyframe's rows are taken for still so
    // are the frame's
    const bool moved = keyframe.row_motion.known() && !prediction.blind;
    const auto pose = world.confirm(keyframe, *frame, tracking.pose.T_keyframe_camera,
                                    moved ? tracking.rows : motion.stillRows());
    if (!pose) {
        tracking.reject(tracking.doubtful
                            ? tracking.depth_fault
                            : Fault{"the edges do not confirm a pose " + gap + " after the last"});
        return tracking;
    }
    Prediction onwards = prediction;
    if (tracking.searched) onwards.prior = prediction.search_prior;  // it is not where it was likely to be
    Tracking again = tracker->trackFrom(keyframe, *frame, onwards, pose->T_keyframe_camera);
    again.searched = tracking.searched || prediction.blind;
    again.ms_coarse += tracking.ms_coarse;
    again.ms_fine += tracking.ms_fine;
    if (again.tracked && again.searched)
        again.fault = tracking.fault ? tracking.fault : Fault{"a gap of " + gap};
    return again;
}

/// The frame becomes a keyframe where it was recognised, if it can be one.
std::optional<Outcome> Odometry::Impl::anchorAt(const RelativePose& found, const Tracking& failed) {
    Outcome outcome;
    outcome.tracking = failed;
    outcome.tracking.pose = found;
    outcome.tracking.matches = {};  // with another keyframe
    outcome.tracking.rows = motion.stillRows();
    outcome.tracking.depth_fault = {};  // found in the failed pose
    outcome.tracking.doubtful = false;
    if (promote(*frame, outcome.tracking)) return std::nullopt;
    motion.anchor(frame->timestamp(), Pose::Identity());
    lost_frames = 0;
    outcome.tracking.inliers = 0;  // they were another keyframe's
    outcome.tracking.pose = {world.reference().id, Pose::Identity(), {}};
    outcome.found_at = found.keyframe;
    outcome.is_keyframe = outcome.new_keyframe = true;
    return outcome;
}

/// The newest keyframe may be the worse one to track from: blurred, covered, or of little that is seen now.
std::optional<RelativePose> Odometry::Impl::trackFromPrevious() {
    Pose T_previous_reference;
    const Keyframe* previous = options.loss.recognise ? world.previous(T_previous_reference) : nullptr;
    if (previous == nullptr) return std::nullopt;
    MotionModel from_there = motion;
    from_there.changeReference(T_previous_reference);
    const Prediction prediction = from_there.predict(frame->timestamp());
    Tracking tracking = tracker->track(*previous, *frame, prediction);
    if (tracking.tracked) tracking = confirmed(*previous, std::move(tracking), prediction);
    if (tracking.lost() || tracking.doubtful) return std::nullopt;
    return tracking.pose;
}

/// Which of two frames is the keyframe decides much: where none leads to this frame, it may lead back to the
/// last one that was tracked.
std::optional<RelativePose> Odometry::Impl::trackFromHere() {
    if (!options.loss.recognise || !frame_before) return std::nullopt;
    const auto here = world.outside(*frame, motion.stillRows());
    if (!here) return std::nullopt;
    MotionModel backwards = startingHere(Pose::Identity());
    backwards.expect(-frame_before->timestamp());
    const Tracking back = tracker->track(*here, *frame_before, backwards.predict(-frame_before->timestamp()));
    if (back.lost()) return std::nullopt;
    return world.confirm(world.reference(), *frame,
                         motion.measuredPose() * back.pose.T_keyframe_camera.inverse(), motion.stillRows());
}

/// Where tracking lost the camera, a keyframe that it has seen before may tell where it is.
Outcome Odometry::Impl::findAgain(Outcome outcome, double since_measured) {
    auto pose = world.find(*frame, {world.reference().id, motion.lastPose(), {}}, since_measured);
    if (!pose) pose = trackFromPrevious();
    if (!pose) pose = trackFromHere();
    if (auto found = pose ? anchorAt(*pose, outcome.tracking) : std::nullopt) return *found;
    return bridge(std::move(outcome), since_measured);
}

Outcome Odometry::Impl::bridge(Outcome outcome, double since_measured) {
    outcome.lost_frames = ++lost_frames;
    candidate.reset();
    if (lost_frames == 1) lost_since = frame->timestamp();
    const bool bridging = kFrameRate * (frame->timestamp() - lost_since) < options.loss.max_predicted - 0.5;
    if (bridging)
        motion.assume(motion.predict(frame->timestamp()).T_reference_camera);
    else
        motion.forgetVelocity();
    // A lost pose is worth little: say so, growing with time
    RelativePose& pose = outcome.tracking.pose;
    pose = {world.reference().id, motion.lastPose(), motion.predict(frame->timestamp()).prior.errors};
    pose.uncertainty.independent += 1e-2 * kFrameRate * since_measured * Matrix6d::Identity();
    outcome.status = bridging ? FrameStatus::kPredicted : FrameStatus::kLost;
    if (!bridging)
        beginTrack(world.trajectory().worldPose(pose), world.trajectory().worldCovariance(pose),
                   since_measured, outcome);
    return outcome;
}

/// Backwards in time, from a pose of this frame.
MotionModel Odometry::Impl::startingHere(const Pose& T_keyframe_camera) const {
    MotionModel backwards(options.motion, options.sensor, camera.height);
    backwards.expect(-frame->timestamp());
    backwards.anchor(-frame->timestamp(), T_keyframe_camera);
    return backwards;
}

/// Frames in which the camera was lost are tracked once more from where it was found, backwards in time.
void Odometry::Impl::trackBack(const Tracking& tracking) {
    MotionModel backwards = startingHere(tracking.pose.T_keyframe_camera);
    if (measured) {  // the frame before, in which the camera was found
        backwards.expect(-frame_before->timestamp());
        backwards.measure(-frame_before->timestamp(), motion.lastPose());
    }
    for (; !lost.empty(); lost.pop_back()) {
        const Frame& before = *lost.back();
        backwards.expect(-before.timestamp());
        Prediction prediction = backwards.predict(-before.timestamp());
        if (prediction.blind) continue;
        prediction.shutter.rows.seconds_per_row = -motion.secondsPerRow();  // time and velocity are negative
        const Tracking again = tracker->track(world.reference(), before, prediction);
        if (again.lost() || again.depth_fault) continue;
        backwards.measure(-before.timestamp(), again.pose.T_keyframe_camera, again.measured);
        world.measureAfterwards(before.timestamp(), again.pose);
    }
}

}  // namespace roevo
