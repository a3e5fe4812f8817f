#pragma once
#include <string>
#include <vector>

#include "roevo/edge_map.h"
#include "roevo/types.h"

namespace roevo {

enum class FrameStatus {
    kOk,           ///< tracked
    kInitialised,  ///< first usable frame, or re-anchored after a loss: a new keyframe with no measured
                   ///< motion
    kPredicted,    ///< tracking lost, or the image frozen: constant velocity
    kLost,         ///< tracking lost for longer than prediction is trusted; pose held
    kRejected      ///< bad input, not processed; no pose
};
const char* toString(FrameStatus status);

/// Milliseconds spent in each stage of one frame.
struct StageTimes {
    double edges = 0, coarse = 0, fine = 0, total = 0;
    double mapping = 0;      ///< of the keyframe whose map took effect with this frame, in its own thread
    double mapping_cpu = 0;  ///< the same as processor time of that thread
    double waiting = 0;      ///< for mapping to finish; part of the total
};

/// What became of one frame.
struct FrameResult {
    double timestamp = 0;
    int index = -1;  ///< place in Odometry::liveTrajectory(), as motion() wants it; -1 when rejected
    FrameStatus status = FrameStatus::kRejected;
    std::string reason;                      ///< in words; empty only when all is well
    Pose T_world_camera = Pose::Identity();  ///< meaningless when rejected
    /// Of T_world_camera: position (m) then orientation (rad), both along the world's axes; the orientation
    /// error phi is meant as R <- exp(phi) R. Meaningless when rejected: ask hasPose() first.
    Matrix6d covariance = Matrix6d::Zero();
    int keyframe = -1;                  ///< id of the one that the pose is relative to; -1 when rejected
    bool new_keyframe = false;          ///< brought a new keyframe: itself, the frame before it, or both
    int num_edges = 0, num_points = 0;  ///< organized edges and their points in this frame
    int found_at = -1;                  ///< keyframe that a lost camera was recognised by
    int joined_at = -1;                 ///< keyframe of another track; the younger of both tracks was moved
    int closed_at = -1;                 ///< keyframe that a loop was closed to
    double matched_ratio = 0;           ///< share of the keyframe's visible edges that were associated, 0..1
    int inliers = 0;                    ///< associated edge points (in tr: that passed the chi-square test)
    /// m: how far the map, a place that was recognised, or (in tr) an older keyframe that is the reference
    /// again moved the camera before this frame's pose was known; positions before and after differ by it
    /// without any motion.
    double map_correction = 0;
    double map_turn = 0;                   ///< rad: how far the camera turned, likewise
    std::vector<MapRefusal> map_refusals;  ///< where mapping left something as it was
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
    /// The first keyframe of its track. After a loss another track may begin, about where the camera may be;
    /// once a place of the older one is recognised, both are one. What is between tracks means nothing.
    int track = 0;
};

}  // namespace roevo
