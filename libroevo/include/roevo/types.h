#pragma once
/// Aliases used everywhere in the core. Poses are named `T_a_b`: they map a point given in frame b into frame
/// a.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roevo {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180;  ///< rad

using Pose = Eigen::Isometry3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A pose with its time (seconds). T_world_camera maps optical camera coordinates into the world.
struct StampedPose {
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
};

}  // namespace roevo
