#include "pose_history.h"

#include <algorithm>

#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

constexpr double kStill = 0.02;      // m; less change of view than this is hardly any
constexpr double kTypicalDepth = 2;  // m; at this depth a turn by 1 rad changes a view like so many metres

double changeOfView(const Pose& motion) {
    return motion.translation().norm() + kTypicalDepth * rotationAngle(motion);
}

}  // namespace

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

Pose PoseHistory::finalPose(const Frame& frame) const {
    const Link& link = frame.link;
    if (link.keyframe < 0) return link.T_parent_camera;
    const Pose from_parent = keyframePose(link.keyframe) * link.T_parent_camera;
    const auto next = static_cast<std::size_t>(link.keyframe) + 1;
    if (next >= links_.size() || links_[next].keyframe != link.keyframe) return from_parent;
    const Pose T_next_camera = links_[next].T_parent_camera.inverse() * link.T_parent_camera;
    const Pose from_next = keyframes_[next].T_world_camera * T_next_camera;
    // Where the camera hardly moves, changes are noise of tracking, and time shares better
    const double begin = keyframes_[next - 1].timestamp, end = keyframes_[next].timestamp;
    const double passed = end > begin ? std::clamp((frame.timestamp - begin) / (end - begin), 0.0, 1.0) : 1;
    const double since = changeOfView(link.T_parent_camera) + kStill * passed;
    const double left = changeOfView(T_next_camera) + kStill * (1 - passed);
    return interpolate(from_parent, from_next, since / (since + left));
}

std::vector<StampedPose> PoseHistory::frames() const {
    std::vector<StampedPose> poses;
    for (const Frame& frame : frames_) poses.push_back({frame.timestamp, finalPose(frame)});
    return poses;
}

}  // namespace roevo
