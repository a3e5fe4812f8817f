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
    if (keyframeIsDue(world.reference(), outcome.tracking, options.keyframe))
        renewReference(outcome);  // Sec. VI
    else
        lookForOtherTrack(outcome);
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
