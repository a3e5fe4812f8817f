#include "roevo/odometry.h"

#include <limits>
#include <optional>
#include <stdexcept>

#include "front_end.h"
#include "input_check.h"
#include "keyframe_maker.h"
#include "mapping/mapper.h"
#include "outcome.h"
#include "relocaliser.h"
#include "semi_dense_store.h"
#include "stopwatch.h"
#include "tracking/camera_scale.h"
#include "tracking/se3.h"
#include "trajectory.h"

namespace roevo {

namespace {

// How far a lost camera can have come
constexpr double kReach = 0.3;     // m
constexpr double kTopSpeed = 1.5;  // m/s

}  // namespace

struct Odometry::Impl {
    Impl(const PinholeCamera& raw, const OdometryOptions& opts, const Pose& start,
         std::unique_ptr<Tracker> own_tracker)
        : camera(raw),
          options(opts),
          scaled(scaledTo(raw, opts)),
          T_world_start(start),
          front_end(raw, scaled),
          tracker(std::move(own_tracker)),
          motion(opts.motion, opts.sensor, raw.height),
          mapper(makeMapper(raw.undistorted(), scaled)),
          relocaliser(raw, opts),
          semi_dense(raw, opts) {}

    PinholeCamera camera;
    OdometryOptions options, scaled;  // as given, and for this camera
    Pose T_world_start;
    FrontEnd front_end;
    std::unique_ptr<Tracker> tracker;
    MotionModel motion;  // relative to the reference, as all but the trajectory
    std::unique_ptr<Mapper> mapper;
    Relocaliser relocaliser;
    SemiDenseStore semi_dense;
    Trajectory trajectory;

    std::unique_ptr<Frame> frame = std::make_unique<Frame>(), frame_before = std::make_unique<Frame>();
    std::unique_ptr<Keyframe> reference;
    std::optional<Tracking> candidate;  // of the frame before, if it can still become a keyframe
    double last_timestamp = -std::numeric_limits<double>::infinity();
    bool recognising = true;
    std::int32_t next_cluster = 0;
    int lost_frames = 0;
    double lost_since = 0, lost_for = 0;  // s

    FrameResult processFrame(const RgbdFrame& images);
    FrameResult applyMapUpdates();
    Outcome start();
    Tracking confirmed(Tracking tracking, const Prediction& prediction);
    Outcome findAgain(Tracking failed, double since_measured);
    Outcome bridge(Tracking failed, double since_measured);
    void join(Outcome& outcome);
    Outcome renewReference(Tracking tracking);
    void learn(const Tracking& tracking, const RollingShutter& shutter);
    void settle(const Outcome& outcome, const PoseUncertainty& measured);
    Fault beginTrack(const Pose& T_world_camera, const Matrix6d& covariance);
    Fault promote(const Frame& promoted, const Tracking& tracked);
    void adopt(std::unique_ptr<Keyframe> fresh, const Frame& of, const RelativePose& tracked);
    FrameResult report(FrameResult result, const Outcome& outcome);
    Trajectory finalPoses() const;
};

/// The paper's pipeline figure.
FrameResult Odometry::Impl::processFrame(const RgbdFrame& images) {
    if (const Fault fault = inputFault(images, camera, last_timestamp))
        return rejected(images.timestamp, fault);
    last_timestamp = images.timestamp;
    FrameResult result = applyMapUpdates();
    const Stopwatch watch;
    std::swap(frame, frame_before);
    front_end.process(images, *frame);  // Sec. IV
    result.ms.edges = watch.milliseconds();
    if (!reference) return report(std::move(result), start());

    reference->setRowMotion(reference->row_motion.at(motion.secondsPerRow()));
    const Prediction prediction = motion.predict(images.timestamp);
    Tracking tracking = tracker->track(*reference, *frame, prediction);  // Sec. V
    if (tracking.lost()) tracking = tracker->search(*reference, *frame, prediction, std::move(tracking));
    if (tracking.tracked && prediction.blind && recognising)
        tracking = confirmed(std::move(tracking), prediction);
    if (tracking.lost())
        return report(std::move(result), findAgain(std::move(tracking), prediction.since_measured));

    lost_frames = 0;
    learn(tracking, prediction.shutter);
    const PoseUncertainty measured = tracking.pose.uncertainty;
    Outcome outcome;
    if (keyframeIsDue(*reference, tracking, options.keyframe))
        outcome = renewReference(std::move(tracking));  // Sec. VI
    else
        outcome.tracking = std::move(tracking);
    settle(outcome, measured);
    if (outcome.is_keyframe) join(outcome);
    result = report(std::move(result), outcome);
    if (!outcome.is_keyframe) candidate = std::move(outcome.tracking);
    return result;
}

FrameResult Odometry::Impl::applyMapUpdates() {
    FrameResult result;
    for (MapUpdate& update : mapper->due(last_timestamp, result.ms.waiting)) {
        const RelativePose last{reference->id, motion.lastPose(), {}};
        const Pose before = trajectory.worldPose(last);
        trajectory.apply(update);
        const Pose after = trajectory.worldPose(last);
        result.map_correction += (after.translation() - before.translation()).norm();
        result.map_turn += rotationAngle(after * before.inverse());
        result.ms.mapping += update.milliseconds;
        result.map_refusals.insert(result.map_refusals.end(), update.refusals.begin(), update.refusals.end());
        if (update.keyframe != reference->id || update.verdicts.empty()) continue;
        std::vector<bool> pseudo;
        for (const EdgeVerdict verdict : update.verdicts) pseudo.push_back(isPseudo(verdict));
        reference->weaken(pseudo, options.mapping.pseudo_weight);
    }
    return result;
}

Outcome Odometry::Impl::start() {
    Outcome outcome;
    outcome.tracking.fault = beginTrack(T_world_start, Matrix6d::Zero());
    if (outcome.tracking.fault) {
        outcome.status = FrameStatus::kRejected;
        return outcome;
    }
    outcome.status = FrameStatus::kInitialised;
    outcome.tracking.pose.keyframe = reference->id;
    outcome.new_keyframe = true;
    return outcome;
}

/// A track that was begun after a loss is moved to where one of its keyframes is recognised.
void Odometry::Impl::join(Outcome& outcome) {
    const int begin = trajectory.beginOfTrack(reference->id);
    if (begin == 0 || !recognising) return;
    const Whereabouts near{trajectory.keyframePose(reference->id).translation(),
                           kReach + kTopSpeed * lost_for};
    const auto pose = relocaliser.find(*frame, trajectory, near, begin);
    if (!pose) return;
    mapper->join(trajectory.join(reference->id, *pose));
    outcome.joined_at = pose->keyframe;
    lost_for = 0;
}

/// After a gap in time any pose may look right to tracking: the edges must agree without what is likely.
Tracking Odometry::Impl::confirmed(Tracking tracking, const Prediction& prediction) {
    const int gap_ms = static_cast<int>(1e3 * prediction.since_measured);
    const auto pose = relocaliser.confirm(*reference, *frame, tracking.pose.T_keyframe_camera);
    if (!pose) {
        tracking.reject({Fault::Kind::kUnconfirmed, {gap_ms}});
        return tracking;
    }
    Tracking again = tracker->trackFrom(*reference, *frame, prediction, *pose);
    again.searched = true;
    again.ms_coarse += tracking.ms_coarse;
    again.ms_fine += tracking.ms_fine;
    if (again.tracked) again.fault = tracking.fault ? tracking.fault : Fault{Fault::Kind::kGap, {gap_ms}};
    return again;
}

/// Where tracking lost the camera, a keyframe that it has seen before may tell where it is.
Outcome Odometry::Impl::findAgain(Tracking failed, double since_measured) {
    const RelativePose last{reference->id, motion.lastPose(), {}};
    const Whereabouts near{trajectory.worldPose(last).translation(), kReach + kTopSpeed * since_measured};
    const auto pose =
        recognising ? relocaliser.find(*frame, trajectory, near, reference->id + 1) : std::nullopt;
    if (!pose) return bridge(std::move(failed), since_measured);
    Outcome outcome;
    outcome.tracking = failed;
    outcome.tracking.pose = *pose;
    outcome.tracking.matches = {};  // with another keyframe
    outcome.tracking.rows = motion.stillRows();
    if (promote(*frame, outcome.tracking)) return bridge(std::move(failed), since_measured);
    motion.anchor(frame->timestamp(), Pose::Identity());
    lost_frames = 0;
    lost_for = 0;
    outcome.tracking.inliers = 0;  // they were another keyframe's
    outcome.tracking.pose = {reference->id, Pose::Identity(), {}};
    outcome.found_at = pose->keyframe;
    outcome.is_keyframe = outcome.new_keyframe = true;
    return outcome;
}

Outcome Odometry::Impl::bridge(Tracking failed, double since_measured) {
    Outcome outcome;
    outcome.lost_frames = ++lost_frames;
    candidate.reset();
    if (lost_frames == 1) lost_since = frame->timestamp();
    const bool bridging = kFrameRate * (frame->timestamp() - lost_since) < options.loss.max_predicted - 0.5;
    if (bridging)
        motion.assume(motion.predict(frame->timestamp()).T_reference_camera);
    else
        motion.forgetVelocity();
    // A lost pose is worth little: say so, growing with every frame
    RelativePose& pose = failed.pose;
    pose = {reference->id, motion.lastPose(), {lost_frames * 1e-2 * Matrix6d::Identity(), {}}};
    outcome.status = bridging ? FrameStatus::kPredicted : FrameStatus::kLost;
    if (!bridging && !beginTrack(trajectory.worldPose(pose), trajectory.worldCovariance(pose))) {
        outcome.status = FrameStatus::kInitialised;
        outcome.new_keyframe = true;
        lost_for += since_measured;
        lost_frames = 0;
        pose = {reference->id, Pose::Identity(), {}};
    }
    outcome.tracking = std::move(failed);
    return outcome;
}

Outcome Odometry::Impl::renewReference(Tracking tracking) {
    Outcome outcome;
    // A frame that suddenly sees less is often a blurred one, and a bad keyframe. The frame before it was
    // still tracked well: it takes over, and this frame is tracked once more, from nearer by.
    const bool sees_less = tracking.matchedRatio() < options.keyframe.min_overlap;
    const bool takes_over = sees_less && candidate && candidate->matchedRatio() > tracking.matchedRatio();
    const RelativePose promoted = takes_over ? candidate->pose : tracking.pose;
    outcome.no_keyframe = takes_over ? promote(*frame_before, *candidate) : promote(*frame, tracking);
    outcome.new_keyframe = !outcome.no_keyframe;
    outcome.tracking = std::move(tracking);
    if (outcome.no_keyframe) return outcome;
    outcome.tracking.pose = changeReference(outcome.tracking.pose, promoted, reference->id);
    outcome.is_keyframe = !takes_over;
    if (outcome.is_keyframe) {
        outcome.tracking.pose.uncertainty = PoseUncertainty();
        return outcome;
    }
    const Prediction prediction = motion.predict(frame->timestamp());
    Tracking again =
        tracker->trackFrom(*reference, *frame, prediction, outcome.tracking.pose.T_keyframe_camera);
    again.ms_coarse += outcome.tracking.ms_coarse;
    again.ms_fine += outcome.tracking.ms_fine;
    if (again.tracked) {
        learn(again, prediction.shutter);
        again.searched = outcome.tracking.searched;
        again.fault = outcome.tracking.fault;
        outcome.tracking = std::move(again);
    }
    return outcome;
}

/// What a tracked frame tells besides its pose.
void Odometry::Impl::learn(const Tracking& tracking, const RollingShutter& shutter) {
    motion.setBrightness(tracking.brightness);
    reference->count(tracking.matches.visible, tracking.found);
    if (!reference->row_motion.known()) {
        reference->setRowMotion(
            motion.firstRows(frame->timestamp() - reference->timestamp, tracking.pose.T_keyframe_camera));
    } else if (options.mode != Mode::kCoarse && options.sensor.estimate_readout &&
               shutter.since_previous > 0) {
        tracker->learnReadout(*reference, *frame, tracking, shutter, motion.readout());
    }
}

/// A tracked pose is what the next one is predicted from.
/// @param measured  its uncertainty, which a keyframe no longer has relative to itself
void Odometry::Impl::settle(const Outcome& outcome, const PoseUncertainty& measured) {
    const RelativePose& pose = outcome.tracking.pose;
    if (outcome.tracking.searched)
        motion.anchor(frame->timestamp(), pose.T_keyframe_camera);
    else
        motion.measure(frame->timestamp(), pose.T_keyframe_camera, measured);
}

Fault Odometry::Impl::beginTrack(const Pose& T_world_camera, const Matrix6d& covariance) {
    auto fresh = std::make_unique<Keyframe>();
    if (const Fault fault = makeKeyframe(*frame, motion.stillRows(), camera, scaled, *tracker, *fresh))
        return fault;
    numberEdges(*fresh, nullptr, {}, next_cluster);
    fresh->id = trajectory.beginTrack(frame->timestamp(), T_world_camera, covariance);
    motion.anchor(frame->timestamp(), Pose::Identity());
    motion.setBrightness(Brightness());
    adopt(std::move(fresh), *frame, RelativePose());
    return {};
}

Fault Odometry::Impl::promote(const Frame& promoted, const Tracking& tracked) {
    auto fresh = std::make_unique<Keyframe>();
    if (const Fault fault = makeKeyframe(promoted, tracked.rows, camera, scaled, *tracker, *fresh))
        return fault;
    const RelativePose pose = tracked.pose;  // the tracking may be the candidate, which adopt() drops
    numberEdges(*fresh, reference.get(), tracked.matches, next_cluster);
    fresh->id = trajectory.addKeyframe(promoted.timestamp(), pose, fresh->clusters);
    motion.changeReference(pose.T_keyframe_camera.inverse());
    adopt(std::move(fresh), promoted, pose);
    return {};
}

void Odometry::Impl::adopt(std::unique_ptr<Keyframe> fresh, const Frame& of, const RelativePose& tracked) {
    if (recognising) relocaliser.add(*fresh, of);
    semi_dense.add(fresh->edges.image, of, fresh->row_motion);
    mapper->insert({*fresh, ownEdges(*fresh, of.images, camera), trajectory.keyframePose(fresh->id), tracked,
                    reference.get(), motion.secondsPerRow()},
                   frame->timestamp());
    reference = std::move(fresh);
    candidate.reset();
}

FrameResult Odometry::Impl::report(FrameResult result, const Outcome& outcome) {
    const Tracking& tracking = outcome.tracking;
    result.timestamp = frame->timestamp();
    result.status = outcome.status;
    result.num_edges = frame->edges.numEdges();
    result.num_points = static_cast<int>(frame->edges.size());
    if (outcome.status == FrameStatus::kRejected) {
        result.reason = "cannot start here: " + describe(tracking.fault);
        return result;
    }
    const bool measured = outcome.status != FrameStatus::kPredicted && outcome.status != FrameStatus::kLost;
    trajectory.addFrame(result.timestamp, tracking.pose, measured);
    result.reason = describe(outcome);
    result.T_world_camera = trajectory.worldPose(tracking.pose);
    result.covariance = trajectory.worldCovariance(tracking.pose);
    result.new_keyframe = outcome.new_keyframe;
    result.matched_ratio = tracking.matchedRatio();
    result.inliers = tracking.inliers;
    result.ms.coarse = tracking.ms_coarse;
    result.ms.fine = tracking.ms_fine;
    return result;
}

Trajectory Odometry::Impl::finalPoses() const {
    Trajectory poses = trajectory;
    for (const MapUpdate& update : mapper->outstanding()) poses.apply(update);
    return poses;
}

Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start)
    : Odometry(camera, options, T_world_start, nullptr) {}
Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start,
                   std::unique_ptr<Tracker> tracker) {
    if (const auto fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
    if (const auto fault = checkOptions(options); !fault.empty()) throw std::invalid_argument(fault);
    if (!T_world_start.isFinite()) throw std::invalid_argument("the start pose is not finite");
    // What the tracker of an experiment loses stays lost: what is found without it is not its merit
    const bool recognising = tracker == nullptr;
    if (!tracker) tracker = std::make_unique<Tracker>(camera, options);
    impl_ = std::make_unique<Impl>(camera, options, T_world_start, std::move(tracker));
    impl_->recognising = recognising;
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

FrameResult Odometry::processFrame(const RgbdFrame& images) {
    const Stopwatch watch;
    FrameResult result = impl_->processFrame(images);
    result.ms.total = watch.milliseconds();
    return result;
}

std::vector<StampedPose> Odometry::trajectory() const {
    return impl_->finalPoses().frames();
}
std::vector<StampedPose> Odometry::liveTrajectory() const {
    return impl_->trajectory.live();
}
Matrix6d Odometry::motionCovariance(std::size_t from, std::size_t to) const {
    return impl_->trajectory.motionCovariance(from, to);
}
std::vector<KeyframeInfo> Odometry::keyframes() const {
    return impl_->finalPoses().keyframes();
}
EdgeMap Odometry::map() const {
    return impl_->mapper->fusedMap();
}
EdgeMap Odometry::keyframeEdges() const {
    return impl_->mapper->keyframeEdges();
}
std::vector<ColouredPoint> Odometry::semiDense() const {
    return impl_->semi_dense.inWorld(impl_->finalPoses().keyframes());
}
double Odometry::readoutTime() const {
    return impl_->motion.secondsPerRow() * impl_->camera.height;
}
const PinholeCamera& Odometry::camera() const {
    return impl_->camera;
}
const OdometryOptions& Odometry::options() const {
    return impl_->options;
}

}  // namespace roevo
