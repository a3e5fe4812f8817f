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

/// A pose with its covariance as MRPT's Gaussian over x y z yaw pitch roll.
/// @param covariance  6x6 of a small motion applied from the left in the world, T = exp(d) T_world_body;
/// order tx ty tz (m)
///                    rx ry rz (rad)
/// First order; yaw and roll become one near pitch = +-90 degrees, where their variance grows without bound.
mrpt::poses::CPose3DPDFGaussian toMrptGaussian(const Pose& T_world_body, const Matrix6d& covariance);

}  // namespace roevo
