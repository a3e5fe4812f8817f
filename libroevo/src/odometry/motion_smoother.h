#pragma once
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// A camera at some time: its pose as it was measured, or not at all.
struct MotionSample {
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< position, then orientation, along the camera's axes
    bool measured = true;                    ///< else pose and covariance tell nothing
};

/// Moves poses to where they most likely are. Cameras have mass: that a pose jumps to and fro from frame to
/// frame is its error, as far as its covariance allows. Accelerations are taken for white noise (a constant
/// velocity that wanders) with the tails of a t-distribution, because hands jerk; how strong, the poses
/// themselves tell, by their likelihood. A Kalman filter and its smoother (Rauch, Tung, Striebel).
/// @param samples  in time order, the first and the last one measured; poses of those that are not come out,
///                 too. What no frame errs, a keyframe, stays.
void smoothMotion(std::vector<MotionSample>& samples);

}  // namespace roevo
