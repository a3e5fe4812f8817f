#pragma once
/// Keyframes and frames along a line.

#include "odometry/trajectory.h"

namespace roevo::testing {

inline Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

inline RelativePose from(int keyframe, const Pose& T_keyframe_camera) {
    return {keyframe, T_keyframe_camera, {}};
}

inline RelativePose seen(int keyframe, const Pose& pose) {
    return {keyframe, pose, {1e-8 * Matrix6d::Identity(), {}}};
}

inline int beginTrack(Trajectory& trajectory, double timestamp, const Pose& pose) {
    return trajectory.beginTrack(timestamp, pose, Matrix6d::Zero());
}

}  // namespace roevo::testing
