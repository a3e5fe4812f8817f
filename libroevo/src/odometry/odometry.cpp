#include "roevo/odometry.h"

#include <Eigen/LU>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

#include "input_check.h"
#include "keyframe_maker.h"
#include "roevo/camera/undistorter.h"
#include "roevo/edges/edge_extractor.h"
#include "roevo/mapping/local_mapper.h"
#include "roevo/tracking/fine_tracker.h"
#include "roevo/tracking/motion_model.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

class Stopwatch {
  public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Rotations about the camera's x and y axes around a pose, as far as half the field of view: where to look
/// when the camera was turned faster than the trackers converge.
std::vector<Pose> searchAround(const Pose& T_current_keyframe) {
    constexpr double kStep = 3 * kDegree;
    constexpr int kReach = 6;
    std::vector<Pose> guesses;
    for (int yaw = -kReach; yaw <= kReach; ++yaw) {
        for (int pitch = -kReach; pitch <= kReach; ++pitch) {
            Vector6d turn = Vector6d::Zero();
            turn[3] = pitch * kStep;
            turn[4] = yaw * kStep;
            guesses.push_back(poseIncrement(turn) * T_current_keyframe);
        }
    }
    return guesses;
}

}  // namespace

struct TrackedPose {
    double timestamp = 0;
    int keyframe = 0;
    Pose T_keyframe_camera = Pose::Identity();
};

struct KeyframeLink {
    int parent = -1;
    Pose T_parent_camera = Pose::Identity();
};

struct PendingUpdate {
    long due = 0;  ///< index of the frame with which it takes effect
    MapUpdate update;
    double milliseconds = 0;
};

struct Odometry::Impl {
    Impl(const PinholeCamera& raw, const OdometryOptions& opts, const Pose& start)
        : camera(raw),
          ideal(raw.undistorted()),
          options(opts),
          undistorter(raw),
          extractor(opts.edges),
          coarse(opts.coarse),
          fine(opts.fine, opts.edges, opts.sensor),
          T_world_camera(start),
          motion(opts.motion, opts.sensor, raw.height) {
        if (opts.mode == Mode::kBundleAdjustment) mapper = std::make_unique<LocalMapper>(ideal, opts);
    }

    PinholeCamera camera, ideal;
    OdometryOptions options;
    Undistorter undistorter;
    EdgeExtractor extractor;
    CoarseTracker coarse;
    FineTracker fine;

    FrameData now, before;  // the present frame and the one before it
    EdgeGrid grid;          // of the present frame

    std::unique_ptr<Keyframe> keyframe;
    std::vector<KeyframeInfo> keyframe_infos;
    std::vector<KeyframeLink> keyframe_links;
    EdgeMap edge_map;
    std::vector<TrackedPose> poses;
    std::vector<StampedPose> live_poses;
    std::unique_ptr<LocalMapper> mapper;
    std::deque<PendingUpdate> pending;  ///< in the order of keyframes
    long frame_index = 0;
    Pose T_world_camera;  // last pose, measured or predicted
    MotionModel motion;
    Brightness brightness;
    double last_timestamp = -std::numeric_limits<double>::infinity();
    int lost_frames = 0;

    std::string startKeyframe(const FrameData& data);
    void applyMapUpdates(FrameResult& result);
    void applyMapUpdate(const MapUpdate& update, FrameResult& result);
    void keepPose(const FrameResult& result);
    void renewKeyframe(FrameResult& result);
    void keepForKeyframe(const RgbdFrame& frame);
    void process(const RgbdFrame& frame, FrameResult& result);
    bool trackFrame(const RgbdFrame& frame, FrameResult& result);
    bool trackFrom(const std::vector<Pose>& guesses, const PosePrior& prior, const RgbdFrame& frame,
                   FrameResult& result);
    void bridgeLoss(const RgbdFrame& frame, FrameResult& result);
    std::string lackOf(const FineResult& refined) const;
    bool wantsKeyframe(const FrameResult& result) const;
    void setCovariance(const Matrix6d& relative, const Pose& T_current_keyframe, FrameResult& result);
};

std::string Odometry::Impl::startKeyframe(const FrameData& data) {
    auto fresh = std::make_unique<Keyframe>();
    const int id = static_cast<int>(keyframe_infos.size());
    if (auto fault = makeKeyframe(data, id, camera, options, *fresh); !fault.empty()) return fault;
    KeyframeLink link;
    if (keyframe && data.may_be_keyframe) {
        link.parent = keyframe->id;
        link.T_parent_camera = keyframe->T_world_camera.inverse() * data.T_world_camera;
    }
    if (keyframe && mapper) mapper->setFound(keyframe->id, foundShares(*keyframe));
    keyframe = std::move(fresh);
    brightness = Brightness();
    keyframe_infos.push_back({keyframe->id, keyframe->timestamp, keyframe->T_world_camera});
    keyframe_links.push_back(link);
    EdgeMap own_edges = mapEdgesOf(*keyframe, data.images, camera);
    if (mapper) {
        std::vector<Rgb> colours;
        for (const MapEdge& edge : own_edges)
            colours.insert(colours.end(), edge.colours.begin(), edge.colours.end());
        MapKeyframe kept = toMapKeyframe(*keyframe, colours, ideal, options.mapping.max_points);
        kept.parent = link.parent;
        kept.T_parent_camera = link.T_parent_camera;
        if (link.parent >= 0) kept.parent_information = data.relative_covariance.inverse();
        const Stopwatch watch;
        PendingUpdate next;
        next.update = mapper->insert(std::move(kept));
        next.milliseconds = watch.milliseconds();
        next.due = frame_index + options.mapping.latency;
        pending.push_back(std::move(next));
    }
    if (!mapper) {
        for (MapEdge& edge : own_edges) {
            edge.cluster = static_cast<int>(edge_map.size());
            edge_map.push_back(std::move(edge));
        }
    }
    return {};
}

void Odometry::Impl::applyMapUpdates(FrameResult& result) {
    while (!pending.empty() && pending.front().due <= frame_index) {
        result.ms.mapping += pending.front().milliseconds;
        applyMapUpdate(pending.front().update, result);
        pending.pop_front();
    }
}

void Odometry::Impl::applyMapUpdate(const MapUpdate& update, FrameResult& result) {
    for (const auto& [id, pose] : update.poses) {
        keyframe_infos[static_cast<std::size_t>(id)].T_world_camera = pose;
    }
    // Younger keyframes follow the one that they were tracked from
    for (std::size_t id = static_cast<std::size_t>(update.keyframe) + 1; id < keyframe_infos.size(); ++id) {
        const KeyframeLink& link = keyframe_links[id];
        if (link.parent < 0) continue;
        keyframe_infos[id].T_world_camera =
            keyframe_infos[static_cast<std::size_t>(link.parent)].T_world_camera * link.T_parent_camera;
    }
    if (!keyframe) return;
    const Pose T_new = keyframe_infos[static_cast<std::size_t>(keyframe->id)].T_world_camera;
    const Pose correction = T_new * keyframe->T_world_camera.inverse();
    const Eigen::Vector3d position = T_world_camera.translation();
    keyframe->T_world_camera = T_new;
    T_world_camera = correction * T_world_camera;
    orthonormalise(T_world_camera);
    now.T_world_camera = correction * now.T_world_camera;
    motion.moveWorld(correction);
    result.map_correction = (T_world_camera.translation() - position).norm();
    if (update.keyframe == keyframe->id && options.mapping.refine_depth) refineDepth(*keyframe, update);
}

void Odometry::Impl::keepPose(const FrameResult& result) {
    live_poses.push_back({result.timestamp, result.T_world_camera});
    TrackedPose kept;
    kept.timestamp = result.timestamp;
    kept.keyframe = keyframe ? keyframe->id : -1;
    kept.T_keyframe_camera =
        keyframe ? keyframe->T_world_camera.inverse() * result.T_world_camera : result.T_world_camera;
    poses.push_back(kept);
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

bool Odometry::Impl::wantsKeyframe(const FrameResult& result) const {
    const Pose T_keyframe_current = keyframe->T_world_camera.inverse() * result.T_world_camera;
    const double degrees = rotationAngle(T_keyframe_current) / kDegree;
    return result.matched_ratio < options.keyframe.min_matched_ratio ||
           degrees > options.keyframe.max_rotation_deg ||
           T_keyframe_current.translation().norm() >
               options.keyframe.max_translation * keyframe->median_depth;
}

std::string Odometry::Impl::lackOf(const FineResult& refined) const {
    if (refined.inliers < options.fine.min_inliers) {
        return "only " + std::to_string(refined.inliers) + " associated edge points, " +
               std::to_string(options.fine.min_inliers) + " needed";
    }
    if (refined.matched_ratio >= options.fine.min_matched_ratio) return "the pose diverged";
    return "only " + std::to_string(std::lround(100 * refined.matched_ratio)) +
           " % of the edges associated, " +
           std::to_string(std::lround(100 * options.fine.min_matched_ratio)) + " % needed";
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
    const RollingShutter shutter = motion.shutter(frame.timestamp, T_world_keyframe);

    const Stopwatch coarse_watch;
    const CoarseResult aligned = coarse.track(*keyframe, now.pyramid, ideal, shutter, guesses, brightness);
    result.ms.coarse += coarse_watch.milliseconds();

    const Stopwatch fine_watch;
    const FineFrame view{&now.edges, &grid, &now.pyramid, &frame.depth, &camera, &ideal};
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
        const FineResult refined =
            fine.track(*keyframe, view, T_current_keyframe, prior, shutter, aligned.brightness);
        result.inliers = refined.inliers;
        if (!refined.converged) {
            result.matched_ratio = refined.matched_ratio;
            result.ms.fine += fine_watch.milliseconds();
            result.reason = lackOf(refined);
            return false;
        }
        T_current_keyframe = refined.T_current_keyframe;
        covariance = refined.covariance;
    }
    now.row_motion = shutter.motion(T_current_keyframe);
    if (options.mode != Mode::kCoarse && shutter.since_previous > 0) {
        fine.addReadoutEvidence(*keyframe, T_current_keyframe, now.row_motion, view, motion.readout());
    }
    if (mapper) fine.countHits(*keyframe, ideal);
    result.matched_ratio = fine.matches().matchedRatio();
    result.T_world_camera = T_world_keyframe * T_current_keyframe.inverse();
    orthonormalise(result.T_world_camera);
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
    Stopwatch edge_watch;
    std::swap(now, before);
    keepForKeyframe(frame);
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
        if (wantsKeyframe(result)) renewKeyframe(result);
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

void Odometry::Impl::keepForKeyframe(const RgbdFrame& frame) {
    now.images.timestamp = frame.timestamp;
    frame.grey.copyTo(now.images.grey);
    frame.depth.copyTo(now.images.depth);
    frame.colour.copyTo(now.images.colour);
    now.row_motion = motion.stillRows();
    now.covariance.setZero();
    now.may_be_keyframe = false;
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

Odometry::Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start) {
    if (const auto fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
    if (const auto fault = checkOptions(options); !fault.empty()) throw std::invalid_argument(fault);
    if (!T_world_start.matrix().allFinite()) throw std::invalid_argument("the start pose is not finite");
    impl_ = std::make_unique<Impl>(camera, options, T_world_start);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

FrameResult Odometry::processFrame(const RgbdFrame& frame) {
    Stopwatch watch;
    FrameResult result;
    result.timestamp = frame.timestamp;
    if (auto fault = faultOf(frame, impl_->camera, impl_->last_timestamp); !fault.empty()) {
        result.reason = std::move(fault);
        return result;
    }
    impl_->process(frame, result);
    if (result.hasPose()) impl_->keepPose(result);
    result.ms.total = watch.milliseconds();
    return result;
}

std::vector<StampedPose> Odometry::trajectory() const {
    for (; !impl_->pending.empty(); impl_->pending.pop_front()) {
        FrameResult result;
        impl_->applyMapUpdate(impl_->pending.front().update, result);
    }
    std::vector<StampedPose> trajectory;
    for (const TrackedPose& pose : impl_->poses) {
        const Pose& T_world_keyframe =
            impl_->keyframe_infos[static_cast<std::size_t>(pose.keyframe)].T_world_camera;
        trajectory.push_back({pose.timestamp, T_world_keyframe * pose.T_keyframe_camera});
    }
    return trajectory;
}
std::vector<StampedPose> Odometry::liveTrajectory() const {
    return impl_->live_poses;
}
std::vector<KeyframeInfo> Odometry::keyframes() const {
    return impl_->keyframe_infos;
}
EdgeMap Odometry::map() const {
    return impl_->mapper ? impl_->mapper->fusedMap() : impl_->edge_map;
}
EdgeMap Odometry::keyframeEdges() const {
    return impl_->mapper ? impl_->mapper->keyframeEdges() : impl_->edge_map;
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
