#pragma once
/// Between the core's optical frames (x right, y down, z forward) and MRPT's sensor frames (x forward, y
/// left, z up).

#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "roevo/types.h"

namespace roevo {

Pose toEigen(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D toMrpt(const Pose& pose);

/// T_sensor_optical: optical coordinates into the sensor frame of the same camera, CPose3D(0, 0, 0, -90 deg,
/// 0, -90 deg).
Pose sensorFromOptical();

/// Pose of the sensor frame in the world, given the pose of its optical frame there, and back.
mrpt::poses::CPose3D sensorPoseFromOptical(const Pose& T_world_optical);
Pose opticalPoseFromSensor(const mrpt::poses::CPose3D& T_world_sensor);

/// CObservation3DRangeScan::relativePoseIntensityWRTDepth of a colour camera, and back to T_colour_depth
/// (optical frames).
mrpt::poses::CPose3D relativePoseOfColour(const Pose& T_depth_colour);
Pose colourFromDepth(const mrpt::poses::CPose3D& relative_pose_of_colour);

/// Pose of a body fixed to the camera, with its covariance as MRPT's Gaussian over x y z yaw pitch roll.
/// @param T_camera_body  where the body sits in the optical frame (the inverse of the sensor's pose on a
/// robot)
/// @param covariance     as FrameResult::covariance: position (m), then orientation (rad) with R <- exp(phi)
/// R, along the
///                       world's axes
/// First order. Near pitch = +-90 degrees yaw and roll are one, and their variances grow without bound.
mrpt::poses::CPose3DPDFGaussian toMrptGaussian(const Pose& T_world_camera, const Matrix6d& covariance,
                                               const Pose& T_camera_body = Pose::Identity());

}  // namespace roevo
