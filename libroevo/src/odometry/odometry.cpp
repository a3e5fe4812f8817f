#include "roevo/odometry.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "input_check.h"
#include "keyframe_maker.h"
#include "map_link.h"
#include "pose_history.h"
#include "recovery.h"
#include "registration.h"
#include "roevo/camera/undistorter.h"
#include "roevo/edges/edge_extractor.h"
#include "roevo/tracking/fine_tracker.h"
#include "roevo/tracking/motion_model.h"
#include "roevo/tracking/se3.h"
#include "semi_dense_store.h"
#include "stopwatch.h"

namespace roevo {
struct Odometry::Impl {
    Impl(const PinholeCamera& raw, const OdometryOptions& opts, const Pose& start,
         const OdometryStages& replaced)
        : camera(raw),
          ideal(raw.undistorted()),
          options(opts),
          stages(replaced),
          undistorter(raw),
          extractor(opts.edges),
          coarse(opts.coarse),
          fine(opts.fine, opts.edges, opts.sensor),
          T_world_camera(start),
          motion(opts.motion, opts.sensor, raw.height),
          semi_dense(raw, opts) {
        if (opts.mode == Mode::kBundleAdjustment) map = std::make_unique<MapLink>(ideal, opts);
    }

    PinholeCamera camera, ideal;
    OdometryOptions options;
    OdometryStages stages;
    Undistorter undistorter;
    EdgeExtractor extractor;
    CoarseTracker coarse;
    FineTracker fine;

    FrameData now, before;  // the present frame and the one before it
    EdgeGrid grid;          // of the present frame

    std::unique_ptr<Keyframe> keyframe;
    PoseHistory history;
    std::vector<StampedPose> live_poses;
    std::unique_ptr<MapLink> map;  // in mode ba
    EdgeMap edge_map;              // in the other modes
    long frame_index = 0;
    Pose T_world_camera;  // last pose, measured or predicted
    MotionModel motion;
    SemiDenseStore semi_dense;
    Brightness brightness;
    double last_timestamp = -std::numeric_limits<double>::infinity();
    int lost_frames = 0;

    std::string startKeyframe(const FrameData& data);
    void applyMapUpdates(FrameResult& result);
    void applyMapUpdate(const MapUpdate& update, FrameResult& result);
    PoseHistory finalPoses() const;
    void renewKeyframe(FrameResult& result);
    void process(const RgbdFrame& frame, FrameResult& result);
    bool trackFrame(const RgbdFrame& frame, FrameResult& result);
    bool trackFrom(const std::vector<Pose>& guesses, const PosePrior& prior, const RgbdFrame& frame,
                   FrameResult& result);
    void bridgeLoss(const RgbdFrame& frame, FrameResult& result);
    void setCovariance(const Matrix6d& relative, const Pose& T_current_keyframe, FrameResult& result);
};

std::string Odometry::Impl::startKeyframe(const FrameData& data) {
    auto fresh = std::make_unique<Keyframe>();
    const int id = static_cast<int>(history.keyframes().size());
    if (auto fault = makeKeyframe(data, id, camera, options, stages, *fresh); !fault.empty()) return fault;
    const std::unique_ptr<Keyframe> last = std::move(keyframe);
    keyframe = std::move(fresh);
    brightness = Brightness();
    history.addKeyframe({id, keyframe->timestamp, keyframe->T_world_camera},
                        last && data.may_be_keyframe ? last->id : -1);
    semi_dense.add(keyframe->edges.image, data);
    EdgeMap own_edges = mapEdgesOf(*keyframe, data.images, camera);
    if (map) {
        MapJob job;
        job.keyframe = toMapKeyframe(*keyframe, coloursOf(own_edges), ideal, options.mapping.max_points);
        job.keyframe.parent = history.parentOf(id);
        job.keyframe.begins_track = job.keyframe.parent < 0;
        job.keyframe.T_parent_camera = history.parentToKeyframe(id);
        if (job.keyframe.parent >= 0) job.keyframe.parent_information = data.relative_covariance.inverse();
        if (last) {
            job.previous = last->id;
            job.found = foundShares(*last);
            job.previous_rows = last->row_motion;
        }
        job.seconds_per_row = motion.secondsPerRow();
        map->submit(std::move(job), frame_index);
        return {};
    }
    for (MapEdge& edge : own_edges) {
        edge.cluster = static_cast<int>(edge_map.size());
        edge_map.push_back(std::move(edge));
    }
    return {};
}

void Odometry::Impl::applyMapUpdates(FrameResult& result) {
    if (!map) return;
    while (const auto next = map->next(frame_index, result.ms.waiting)) {
        result.ms.mapping += next->milliseconds;
        applyMapUpdate(next->update, result);
    }
}

void Odometry::Impl::applyMapUpdate(const MapUpdate& update, FrameResult& result) {
    history.apply(update);
    result.map_reason += (result.map_reason.empty() || update.reason.empty() ? "" : "; ") + update.reason;
    const Pose& T_world_keyframe = history.keyframePose(keyframe->id);
    const Pose correction = T_world_keyframe * keyframe->T_world_camera.inverse();
    const Eigen::Vector3d position = T_world_camera.translation();
    keyframe->T_world_camera = T_world_keyframe;
    T_world_camera = correction * T_world_camera;
    now.T_world_camera = correction * now.T_world_camera;
    motion.moveWorld(correction);
    result.map_turn += rotationAngle(correction);
    result.map_correction += (T_world_camera.translation() - position).norm();
    if (update.keyframe == keyframe->id) takeFromMap(*keyframe, update);
}

PoseHistory Odometry::Impl::finalPoses() const {
    PoseHistory poses = history;
    if (map) {
        for (const MapResult& result : map->outstanding()) poses.apply(result.update);
    }
    return poses;
}

void Odometry::Impl::setCovariance(const Matrix6d& relative, const Pose& T_current_keyframe,
                                   FrameResult& result) {
    const Eigen::Matrix3d R = result.T_world_camera.linear();
    Matrix6d to_world = Matrix6d::Zero();
    to_world.topLeftCorner<3, 3>() = R;
    to_world.bottomRightCorner<3, 3>() = R;
    Matrix6d from_keyframe = Matrix6d::Identity();
    const Pose T_keyframe_current = T_current_keyframe.inverse();
    from_keyframe.topRightCorner<3, 3>() =
        -skew(keyframe->T_world_camera.linear() * T_keyframe_current.translation());
    now.relative_covariance = to_world * relative * to_world.transpose();
    result.covariance =
        from_keyframe * keyframe->covariance * from_keyframe.transpose() + now.relative_covariance;
}

bool Odometry::Impl::trackFrame(const RgbdFrame& frame, FrameResult& result) {
    const Pose& T_world_keyframe = keyframe->T_world_camera;
    const Pose T_last_keyframe = T_world_camera.inverse() * T_world_keyframe;
    const Pose T_predicted_keyframe = motion.predict(frame.timestamp).inverse() * T_world_keyframe;
    if (trackFrom({T_predicted_keyframe, T_last_keyframe}, motion.prior(frame.timestamp, T_world_keyframe),
                  frame, result)) {
        return true;
    }
    const FrameResult failed = result;
    if (now.edges.numEdges() > 0 &&
        trackFrom(searchAround(T_last_keyframe), motion.searchPrior(frame.timestamp, T_world_keyframe), frame,
                  result)) {
        result.reason = "found by searching around the last pose: " + failed.reason;
        return true;
    }
    result.reason = failed.reason;
    result.inliers = failed.inliers;
    result.matched_ratio = failed.matched_ratio;
    return false;
}

bool Odometry::Impl::trackFrom(const std::vector<Pose>& guesses, const PosePrior& prior,
                               const RgbdFrame& frame, FrameResult& result) {
    const Pose T_world_keyframe = keyframe->T_world_camera;
    setRowMotion(*keyframe, keyframe->row_motion.at(motion.secondsPerRow()));
    RollingShutter shutter = motion.shutter(frame.timestamp, T_world_keyframe);
    // Two images in a row are sheared nearly alike: better both for still than one of them
    if (!keyframe->row_motion.known()) shutter.seconds_per_row = 0;

    const Stopwatch coarse_watch(stages.clock);
    const CoarseResult aligned = coarse.track(*keyframe, now.pyramid, ideal, shutter, guesses, brightness);
    result.ms.coarse += coarse_watch.milliseconds();

    const Stopwatch fine_watch(stages.clock);
    const FineFrame view{frame.timestamp, &now.edges,   &grid,   &extractor.mask(),
                         &now.pyramid,    &frame.depth, &camera, &ideal};
    Pose T_current_keyframe = aligned.T_current_keyframe;
    Matrix6d covariance;
    if (options.mode == Mode::kCoarse) {
        if (!aligned.converged) {
            result.reason =
                "coarse tracking saw too few points in the image: " + std::to_string(aligned.num_visible) +
                " of " + std::to_string(keyframe->photometric.size());
            return false;
        }
        // Edges are associated only to know when the next keyframe is due
        fine.associate(*keyframe, view, T_current_keyframe, shutter.motion(T_current_keyframe),
                       options.fine.final_radius);
        result.inliers = static_cast<int>(fine.matches().size());
        if (fine.matches().matchedRatio() < options.fine.min_matched_ratio / 2) {
            result.reason = "coarse tracking went astray: hardly any edge is where it should be";
            return false;
        }
        covariance = kCorrelatedPoints * (aligned.system.hessian + 1e-9 * Matrix6d::Identity()).inverse();
    } else {
        const FineResult refined = refinePose(stages, fine, *keyframe, view, aligned, prior, shutter);
        result.inliers = refined.inliers;
        if (!refined.converged) {
            result.matched_ratio = refined.matched_ratio;
            result.ms.fine += fine_watch.milliseconds();
            result.reason = lackOf(refined, options.fine);
            return false;
        }
        T_current_keyframe = refined.T_current_keyframe;
        covariance = refined.covariance;
    }
    now.row_motion = shutter.motion(T_current_keyframe);
    if (map) fine.countHits(*keyframe, ideal);
    result.matched_ratio = fine.matches().matchedRatio();
    if (!keyframe->row_motion.known()) {
        setRowMotion(*keyframe, firstMotion(*keyframe, T_current_keyframe, frame.timestamp));
    } else if (options.mode != Mode::kCoarse && options.sensor.estimate_readout &&
               shutter.since_previous > 0) {
        fine.addReadoutEvidence(*keyframe, T_current_keyframe, shutter, view, motion.readout());
    }
    result.T_world_camera = T_world_keyframe * T_current_keyframe.inverse();
    setCovariance(covariance, T_current_keyframe, result);
    brightness = aligned.brightness;
    now.T_world_camera = result.T_world_camera;
    now.covariance = result.covariance;
    now.matched_ratio = result.matched_ratio;
    now.may_be_keyframe = true;
    result.ms.fine += fine_watch.milliseconds();
    return true;
}

void Odometry::Impl::process(const RgbdFrame& frame, FrameResult& result) {
    applyMapUpdates(result);
    const Stopwatch edge_watch(stages.clock);
    std::swap(now, before);
    keepForKeyframe(frame, motion.stillRows(), now);
    const cv::Mat& grey = undistorter.apply(now.images.grey, now.undistorted);
    extractor.extract(grey, now.edges);
    grid.build(now.edges, ideal.width, ideal.height);
    now.pyramid.build(grey, options.coarse.levels);
    result.num_edges = now.edges.numEdges();
    result.num_points = static_cast<int>(now.edges.size());
    result.ms.edges = edge_watch.milliseconds();

    if (!keyframe) {
        result.T_world_camera = now.T_world_camera = T_world_camera;
        const std::string fault = startKeyframe(now);
        if (!fault.empty()) {
            result.status = FrameStatus::kRejected;
            result.reason = "cannot start here: " + fault;
            return;
        }
        result.status = FrameStatus::kInitialised;
        result.reason = "first usable frame";
        result.new_keyframe = true;
        motion.anchor(frame.timestamp, T_world_camera);
    } else if (trackFrame(frame, result)) {
        result.status = FrameStatus::kOk;
        lost_frames = 0;
        const bool by_search = !result.reason.empty();
        if (keyframeIsDue(*keyframe, result, options.keyframe)) renewKeyframe(result);
        T_world_camera = result.T_world_camera;
        if (by_search) {
            motion.anchor(frame.timestamp, T_world_camera);
        } else {
            motion.measure(frame.timestamp, T_world_camera);
        }
    } else {
        bridgeLoss(frame, result);
    }
    last_timestamp = frame.timestamp;
    ++frame_index;
}

void Odometry::Impl::renewKeyframe(FrameResult& result) {
    // A frame that suddenly sees less is often a blurred one, and a bad keyframe. The frame before it was
    // still tracked well: it takes over, and this frame is tracked once more, from nearer by.
    const auto promote = [&](const FrameData& data) {
        const std::string fault = startKeyframe(data);
        if (fault.empty()) {
            result.new_keyframe = true;
        } else {
            result.reason += (result.reason.empty() ? "" : "; ") + ("a new keyframe is due, but " + fault);
        }
        return fault.empty();
    };
    const bool sees_less = result.matched_ratio < options.keyframe.min_matched_ratio;
    if (!sees_less || !before.may_be_keyframe || before.matched_ratio <= result.matched_ratio) {
        if (promote(now)) now.may_be_keyframe = false;
        return;
    }
    const FrameResult first = result;
    if (!promote(before)) return;
    const Pose T_start = result.T_world_camera.inverse() * keyframe->T_world_camera;
    if (!trackFrom({T_start}, motion.prior(now.images.timestamp, keyframe->T_world_camera), now.images,
                   result)) {
        result = first;
        result.new_keyframe = true;
    }
}

void Odometry::Impl::bridgeLoss(const RgbdFrame& frame, FrameResult& result) {
    ++lost_frames;
    const std::string why = result.reason;
    const bool bridging = lost_frames <= options.loss.max_predicted;
    if (!bridging) motion.forgetVelocity();
    result.T_world_camera = bridging ? motion.predict(frame.timestamp) : T_world_camera;
    result.status = bridging ? FrameStatus::kPredicted : FrameStatus::kLost;
    result.reason = (bridging ? "constant velocity: " : "pose held: ") + why;
    T_world_camera = result.T_world_camera;
    // A lost pose is worth little: say so, growing with every frame
    result.covariance = keyframe->covariance + lost_frames * 1e-2 * Matrix6d::Identity();
    now.T_world_camera = T_world_camera;
    now.covariance = result.covariance;
    if (!bridging && startKeyframe(now).empty()) {
        result.status = FrameStatus::kInitialised;
        result.new_keyframe = true;
        result.reason =
            "re-anchored after " + std::to_string(lost_frames) + " frames without tracking: " + why;
        lost_frames = 0;
        motion.anchor(frame.timestamp, T_world_camera);
    }
}

Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start)
    : Odometry(camera, options, T_world_start, OdometryStages()) {}
Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start,
                   const OdometryStages& stages) {
    if (const auto fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
    if (const auto fault = checkOptions(options); !fault.empty()) throw std::invalid_argument(fault);
    if (!T_world_start.isFinite()) throw std::invalid_argument("the start pose is not finite");
    impl_ = std::make_unique<Impl>(camera, options, T_world_start, stages);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

FrameResult Odometry::processFrame(const RgbdFrame& frame) {
    const Stopwatch watch(impl_->stages.clock);
    FrameResult result;
    result.timestamp = frame.timestamp;
    if (auto fault = faultOf(frame, impl_->camera, impl_->last_timestamp); !fault.empty()) {
        result.reason = std::move(fault);
        return result;
    }
    impl_->process(frame, result);
    if (result.hasPose()) {
        impl_->history.addFrame(frame.timestamp, result.T_world_camera);
        impl_->live_poses.push_back({frame.timestamp, result.T_world_camera});
    }
    result.ms.total = watch.milliseconds();
    return result;
}

std::vector<StampedPose> Odometry::trajectory() const {
    return impl_->finalPoses().frames();
}
std::vector<StampedPose> Odometry::liveTrajectory() const {
    return impl_->live_poses;
}
std::vector<KeyframeInfo> Odometry::keyframes() const {
    return impl_->finalPoses().keyframes();
}
EdgeMap Odometry::map() const {
    return impl_->map ? impl_->map->finished().fusedMap() : impl_->edge_map;
}
EdgeMap Odometry::keyframeEdges() const {
    return impl_->map ? impl_->map->finished().keyframeEdges() : impl_->edge_map;
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
