#pragma once
#include <memory>
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/edge_map.h"
#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo {

struct OdometryStages;

enum class FrameStatus {
    kOk,           ///< tracked
    kInitialised,  ///< first usable frame, or re-anchored after a loss: a new keyframe with no measured
                   ///< motion
    kPredicted,    ///< tracking lost: constant velocity
    kLost,         ///< tracking lost for longer than prediction is trusted; pose held
    kRejected      ///< bad input, not processed; no pose
};
const char* toString(FrameStatus status);

/// Milliseconds spent in each stage of one frame.
struct StageTimes {
    double edges = 0, coarse = 0, fine = 0, total = 0;
    double mapping = 0;  ///< of the keyframe whose map took effect with this frame, in its own thread
    double waiting = 0;  ///< for mapping to finish; part of the total
};

/// What became of one frame.
struct FrameResult {
    double timestamp = 0;
    FrameStatus status = FrameStatus::kRejected;
    std::string reason;                      ///< in words; empty only when all is well
    Pose T_world_camera = Pose::Identity();  ///< meaningless when rejected
    /// Of T_world_camera: position (m) then orientation (rad), both along the world's axes; the orientation
    /// error phi is meant as R <- exp(phi) R.
    Matrix6d covariance = Matrix6d::Zero();
    bool new_keyframe = false;          ///< this frame brought a new keyframe: itself or the frame before it
    int num_edges = 0, num_points = 0;  ///< organized edges and their points in this frame
    double matched_ratio = 0;           ///< share of the keyframe's visible edges that were associated, 0..1
    int inliers = 0;                    ///< associated edge points (in tr: that passed the chi-square test)
    /// m: how far the map moved the camera before this frame was tracked (mode ba); positions before and
    /// after differ by it without any motion.
    double map_correction = 0;
    double map_turn = 0;     ///< rad: how far the map turned the camera, likewise
    std::string map_reason;  ///< in words, where mapping left something as it was
    StageTimes ms;

    bool hasPose() const { return status != FrameStatus::kRejected; }
    double sigmaTranslation() const;  ///< m: root of the trace of the translation block
    double sigmaRotationDeg() const;  ///< degrees: root of the trace of the rotation block
};

/// A keyframe as the outside sees it.
struct KeyframeInfo {
    int id = 0;
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
};

/// RGB-D visual odometry from organized edges (Liu et al., ROEVO). Feed frames in time order; not
/// thread-safe.
class Odometry {
  public:
    /// @throws std::invalid_argument when the camera or an option is unusable (one line that names it).
    Odometry(const PinholeCamera& camera, const OdometryOptions& options,
             const Pose& T_world_start = Pose::Identity());
    /// With some stages replaced, for experiments (roevo/odometry_stages.h).
    Odometry(const PinholeCamera& camera, const OdometryOptions& options, const Pose& T_world_start,
             const OdometryStages& stages);
    ~Odometry();
    Odometry(Odometry&&) noexcept;
    Odometry& operator=(Odometry&&) noexcept;

    /// Tracks one frame. Never throws for bad frames: they come back kRejected with a reason.
    FrameResult processFrame(const RgbdFrame& frame);

    /// Final poses of all frames that have one, in time order, unique stamps.
    std::vector<StampedPose> trajectory() const;
    /// The poses as they were known when their frames were processed.
    std::vector<StampedPose> liveTrajectory() const;

    std::vector<KeyframeInfo> keyframes() const;

    /// The 3-D edges in the world: fused over all keyframes in mode ba, else the keyframes' own.
    EdgeMap map() const;
    /// The edges of each keyframe as it saw them, with the cluster that they belong to.
    EdgeMap keyframeEdges() const;
    /// The surface next to the edges of all keyframes, in the world at their final poses, coloured; one
    /// keyframe after the other. Waits for what is still being sampled. Empty when mapping.semi_dense_points
    /// is 0.
    std::vector<ColouredPoint> semiDense() const;

    /// Read-out time of the rolling shutter as learned so far or as set, s.
    double readoutTime() const;

    const PinholeCamera& camera() const;  ///< as given (with distortion)
    const OdometryOptions& options() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
