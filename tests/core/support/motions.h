#pragma once
/// A motion model and motions for it.

#include "core/support/random_pose.h"
#include "tracking/motion_model.h"

namespace roevo::testing {

inline constexpr int kHeight = 480;

inline MotionModel makeModel() {
    return {MotionOptions(), SensorOptions(), kHeight};
}

inline Pose poseOf(const Eigen::Vector3d& translation, double angle, const Eigen::Vector3d& axis) {
    Pose pose = Pose::Identity();
    pose.setRotation(Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix());
    pose.translation() = translation;
    return pose;
}

inline const Pose kStart = poseOf({1, -2, 0.5}, 0.7, {1, 2, -1});
inline const Pose kStep = poseOf({0.02, -0.01, 0.03}, 0.03, {0.2, 1, 0.4});

/// Anchored at 10 s, and measured once, kStep on, `dt` later.
inline MotionModel moving(double dt = 0.1) {
    MotionModel model = makeModel();
    model.anchor(10, kStart);
    model.measure(10 + dt, kStart * kStep);
    return model;
}

}  // namespace roevo::testing
