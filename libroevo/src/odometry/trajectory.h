#pragma once
#include <vector>

#include "mapping/local_mapper.h"
#include "roevo/frame_result.h"
#include "tracking/relative_pose.h"

namespace roevo {

/// The only one that knows the world: poses of keyframes, and of frames relative to them. When the map moves
/// a keyframe, all frames that were tracked against it follow.
class Trajectory {
  public:
    /// A keyframe that was tracked from none: the first, or re-anchored. @return its id
    int beginTrack(double timestamp, const Pose& T_world_camera, const Matrix6d& covariance);
    /// @param pose  relative to the keyframe that it was tracked from. @return its id
    int addKeyframe(double timestamp, const RelativePose& pose);
    void addFrame(double timestamp, const RelativePose& pose);

    /// Moves the keyframes as the map has it; younger ones follow the one that they were tracked from.
    void apply(const MapUpdate& update);

    Pose worldPose(const RelativePose& pose) const;
    /// As FrameResult::covariance.
    Matrix6d worldCovariance(const RelativePose& pose) const;

    const std::vector<KeyframeInfo>& keyframes() const { return keyframes_; }
    const Pose& keyframePose(int id) const { return keyframes_[static_cast<std::size_t>(id)].T_world_camera; }
    /// Poses of the frames. What the map found to be wrong with the tracked motion to the next keyframe was
    /// wrong with the motions of the frames between in part: tracking errs the more the view differs from the
    /// keyframe's.
    std::vector<StampedPose> frames() const;
    /// As they were known when they were added.
    const std::vector<StampedPose>& live() const { return live_; }

  private:
    struct Link {
        int keyframe = -1;  ///< that the pose is relative to, -1: the world
        Pose T_parent_camera = Pose::Identity();
    };
    struct Frame {
        double timestamp = 0;
        Link link;
    };
    Pose finalPose(const Frame& frame) const;

    std::vector<KeyframeInfo> keyframes_;
    std::vector<Matrix6d> covariances_;  ///< of the keyframes, in the world
    std::vector<Link> links_;            ///< of the keyframes
    std::vector<Frame> frames_;
    std::vector<StampedPose> live_;
};

}  // namespace roevo
