#include "pose_history.h"

namespace roevo {

void PoseHistory::addKeyframe(const KeyframeInfo& keyframe, int parent) {
    Link link;
    link.keyframe = parent;
    link.T_parent_camera =
        parent < 0 ? keyframe.T_world_camera : keyframePose(parent).inverse() * keyframe.T_world_camera;
    keyframes_.push_back(keyframe);
    links_.push_back(link);
}

void PoseHistory::addFrame(double timestamp, const Pose& T_world_camera) {
    Frame frame;
    frame.timestamp = timestamp;
    frame.link.keyframe = static_cast<int>(keyframes_.size()) - 1;
    frame.link.T_parent_camera =
        keyframes_.empty() ? T_world_camera : keyframes_.back().T_world_camera.inverse() * T_world_camera;
    frames_.push_back(frame);
}

void PoseHistory::apply(const MapUpdate& update) {
    for (const auto& [id, pose] : update.poses)
        keyframes_[static_cast<std::size_t>(id)].T_world_camera = pose;
    for (auto id = static_cast<std::size_t>(update.keyframe) + 1; id < keyframes_.size(); ++id) {
        if (links_[id].keyframe < 0) continue;
        keyframes_[id].T_world_camera = keyframePose(links_[id].keyframe) * links_[id].T_parent_camera;
    }
}

std::vector<StampedPose> PoseHistory::frames() const {
    std::vector<StampedPose> poses;
    for (const Frame& frame : frames_) {
        const Pose T_world_parent =
            frame.link.keyframe < 0 ? Pose::Identity() : keyframePose(frame.link.keyframe);
        poses.push_back({frame.timestamp, T_world_parent * frame.link.T_parent_camera});
    }
    return poses;
}

}  // namespace roevo
