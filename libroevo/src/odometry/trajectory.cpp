#include "trajectory.h"

#include <algorithm>

#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kStill = 0.02;      // m; less change of view than this is hardly any
constexpr double kTypicalDepth = 2;  // m; at this depth a turn by 1 rad changes a view like so many metres

double changeOfView(const Pose& motion) {
    return motion.translation().norm() + kTypicalDepth * rotationAngle(motion);
}

}  // namespace

int Trajectory::beginTrack(double timestamp, const Pose& T_world_camera, const Matrix6d& covariance) {
    const int id = static_cast<int>(keyframes_.size());
    keyframes_.push_back({id, timestamp, T_world_camera});
    covariances_.push_back(covariance);
    links_.push_back({-1, T_world_camera});
    return id;
}

int Trajectory::addKeyframe(double timestamp, const RelativePose& pose) {
    const int id = static_cast<int>(keyframes_.size());
    const Pose T_world_camera = worldPose(pose);
    covariances_.push_back(worldCovariance(pose));
    keyframes_.push_back({id, timestamp, T_world_camera});
    links_.push_back({pose.keyframe, pose.T_keyframe_camera});
    return id;
}

void Trajectory::addFrame(double timestamp, const RelativePose& pose) {
    frames_.push_back({timestamp, {pose.keyframe, pose.T_keyframe_camera}});
    live_.push_back({timestamp, worldPose(pose)});
}

Pose Trajectory::worldPose(const RelativePose& pose) const {
    return keyframePose(pose.keyframe) * pose.T_keyframe_camera;
}

Matrix6d Trajectory::worldCovariance(const RelativePose& pose) const {
    const Eigen::Matrix3d R = worldPose(pose).linear();
    Matrix6d to_world = Matrix6d::Zero();
    to_world.topLeftCorner<3, 3>() = R;
    to_world.bottomRightCorner<3, 3>() = R;
    // An error of the keyframe's orientation moves what is far from it
    Matrix6d from_keyframe = Matrix6d::Identity();
    from_keyframe.topRightCorner<3, 3>() =
        -skew(keyframePose(pose.keyframe).linear() * pose.T_keyframe_camera.translation());
    const Matrix6d& of_keyframe = covariances_[static_cast<std::size_t>(pose.keyframe)];
    return from_keyframe * of_keyframe * from_keyframe.transpose() +
           to_world * pose.covariance * to_world.transpose();
}

void Trajectory::apply(const MapUpdate& update) {
    for (const auto& [id, pose] : update.poses)
        keyframes_[static_cast<std::size_t>(id)].T_world_camera = pose;
    for (auto id = static_cast<std::size_t>(update.keyframe) + 1; id < keyframes_.size(); ++id) {
        if (links_[id].keyframe < 0) continue;
        keyframes_[id].T_world_camera = keyframePose(links_[id].keyframe) * links_[id].T_parent_camera;
    }
}

Pose Trajectory::finalPose(const Frame& frame) const {
    const Link& link = frame.link;
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

std::vector<StampedPose> Trajectory::frames() const {
    std::vector<StampedPose> poses;
    for (const Frame& frame : frames_) poses.push_back({frame.timestamp, finalPose(frame)});
    return poses;
}

}  // namespace roevo
