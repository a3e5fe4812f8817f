#pragma once
#include <vector>

#include "roevo/mapping/local_mapper.h"
#include "roevo/odometry.h"

namespace roevo {

/// Poses of keyframes, and of frames relative to them: when the map moves a keyframe, all frames that were
/// tracked against it follow.
class PoseHistory {
  public:
    /// @param parent  keyframe that the new one was tracked from, -1: none
    void addKeyframe(const KeyframeInfo& keyframe, int parent);
    /// A frame's pose, tracked against the newest keyframe (or free, when there is none).
    void addFrame(double timestamp, const Pose& T_world_camera);

    /// Moves the keyframes as the map has it; younger ones follow the one that they were tracked from.
    void apply(const MapUpdate& update);

    const std::vector<KeyframeInfo>& keyframes() const { return keyframes_; }
    const Pose& keyframePose(int id) const { return keyframes_[static_cast<std::size_t>(id)].T_world_camera; }
    int parentOf(int id) const { return links_[static_cast<std::size_t>(id)].keyframe; }
    /// T_parent_keyframe, or T_world_keyframe where there is no parent.
    Pose parentToKeyframe(int id) const { return links_[static_cast<std::size_t>(id)].T_parent_camera; }
    /// Poses of the frames. What the map found to be wrong with the tracked motion to the next keyframe was
    /// wrong with the motions of the frames between in part: tracking errs the more the view differs from the
    /// keyframe's.
    std::vector<StampedPose> frames() const;

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
    std::vector<Link> links_;  ///< of the keyframes
    std::vector<Frame> frames_;
};

}  // namespace roevo
