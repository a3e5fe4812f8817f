#pragma once
/// What a dataset can hold beside its images.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// One sample of an inertial sensor, in the sensor's own axes as the dataset gives them.
struct ImuSample {
    double timestamp = 0;                                    ///< s
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2, gravity included
    std::optional<Eigen::Vector3d> angular_velocity;         ///< rad/s; none from a mere accelerometer
};

/// A dataset's ground truth, with camera poses as every program here wants them: of the colour camera,
/// optical axes (x right, y down, z forward), right-handed world, metres, stamps on the images' clock.
struct GroundTruth {
    std::vector<StampedPose> poses;  ///< ascending in time; empty when there is none, or none that is usable
    std::string file;                ///< where it comes from: a file, or the folder of pose files
    std::string note;                ///< in words: what was converted, or why it cannot be used; may be empty
    bool copyable = false;  ///< `file` is a TUM trajectory with exactly these poses: copy, not rewrite

    std::string toText() const;  ///< one line; empty when there is none
};

}  // namespace roevo
