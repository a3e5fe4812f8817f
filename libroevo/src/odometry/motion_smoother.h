#pragma once
#include <vector>

#include "roevo/types.h"

namespace roevo {

constexpr double kLongestGap = 1;  ///< s; across more, a velocity tells nothing

/// A camera at some time: its pose as it was measured, or not at all.
struct MotionSample {
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
    /// Position, then orientation, along the camera's axes, without what is common to neighbours
    Matrix6d covariance = Matrix6d::Zero();
    bool measured = true;  ///< else pose and covariance tell nothing
};

/// Puts poses that were not measured between those that were, by time.
/// @param samples  in time order, the first and the last one measured
void bridgeMotion(std::vector<MotionSample>& samples);

/// Moves poses to where they most likely are. Cameras have mass: that a pose jumps to and fro from frame to
/// frame is its error, as far as its covariance allows. Accelerations are taken for white noise (a constant
/// velocity that wanders) with the tails of a t-distribution, because hands jerk. How strong it is, and how
/// much of the covariances neighbours do not have in common, the poses themselves tell, by their likelihood.
/// A Kalman filter and its smoother (Rauch, Tung, Striebel). What errs nothing, a keyframe, stays.
/// @param samples  as above; in up to a second that was not measured, the camera goes on as it did
void smoothMotion(std::vector<MotionSample>& samples);

}  // namespace roevo
