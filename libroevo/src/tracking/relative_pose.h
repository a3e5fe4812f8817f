#pragma once
#include "roevo/types.h"
#include "tracking/edge_clusters.h"

namespace roevo {

/// A camera's pose relative to a keyframe. Only Trajectory knows where that is in the world.
struct RelativePose {
    int keyframe = -1;
    Pose T_keyframe_camera = Pose::Identity();
    PoseUncertainty uncertainty;  ///< position, then orientation, along the camera's axes

    Matrix6d covariance() const { return uncertainty.covariance(); }
};

/// One sigma along the axis that is known least.
double worstSigma(const Eigen::Matrix3d& covariance);

/// Adds what views from elsewhere have wrong alike, in depth, calibration and the time of rows, to what is
/// known of a pose that was found with nothing known of the motion.
void addErrorsFromElsewhere(PoseUncertainty& uncertainty);

/// What turns errors of position and of orientation to other axes.
Matrix6d turnedBy(const Eigen::Matrix3d& R);

/// How an error of the frame that a pose is relative to, along that frame's axes, moves the camera, along its
/// own: an error of the orientation the more the further off.
Matrix6d carriedTo(const Pose& T_reference_camera);

/// A pose relative to a keyframe whose own pose is relative to another: the errors of both add up.
RelativePose compose(const RelativePose& keyframe, const RelativePose& camera);

/// The same pose relative to another keyframe, whose own pose against the first one is known. What edges do
/// to both cancels; the rest of the errors adds up, also what a prior kept of the one in the other: where
/// edges tell little, the sum is too large.
RelativePose changeReference(const RelativePose& pose, const RelativePose& new_keyframe, int id);

}  // namespace roevo
