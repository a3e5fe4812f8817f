#pragma once
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"

namespace mrpt::obs {
class CObservation3DRangeScan;
}

namespace roevo {

/// The colour camera of a scan, in which frames made from it live.
/// @throws std::runtime_error "no intrinsics …" when it is empty, or when its size is not the image's.
PinholeCamera colourCameraOf(const mrpt::obs::CObservation3DRangeScan& scan);

/// The camera of a scan's range image, which may be another one. @throws std::runtime_error as
/// colourCameraOf()
PinholeCamera depthCameraOf(const mrpt::obs::CObservation3DRangeScan& scan);

/// T_colour_depth as toRgbdFrame() finds it in a scan that was written with `T_depth_colour`: rawlogs hold
/// rotations as quaternions, which changes the last bits.
Pose colourFromDepthAsStored(const Pose& T_depth_colour);

/// Turns a scan into a frame for the odometry: depth in metres registered to the colour camera (untouched
/// when both cameras coincide), ranges along the ray turned into depth, 8-bit grey. External images are
/// decoded here and not kept by the scan.
/// @throws std::runtime_error in one line: no depth, no image, a missing or damaged file (named), no
/// intrinsics, sizes that do not fit the intrinsics, a pose of sensor or colour camera that is not rigid.
RgbdFrame toRgbdFrame(const mrpt::obs::CObservation3DRangeScan& scan);

/// A scan of a frame, for toRgbdFrame() to give the same frame again: everything in memory, depth in 1/5000 m
/// (13.1 m at most, else unknown).
/// @param T_robot_camera  optical axes
mrpt::obs::CObservation3DRangeScan toScan(const RgbdFrame& frame, const PinholeCamera& camera,
                                          const Pose& T_robot_camera);

/// Whether toRgbdFrame() takes the depth as stored: both cameras coincide, and it is no range along the ray.
bool depthIsAsStored(const mrpt::obs::CObservation3DRangeScan& scan);

/// Whether the sensor sits elsewhere than on the robot's origin, looking along its x axis.
bool isMountedOnRobot(const mrpt::obs::CObservation3DRangeScan& scan);

/// T_robot_camera of the colour camera (optical axes) on the robot (x forward, y left, z up): the scan's
/// sensorPose, then the colour camera's pose on the sensor.
Pose cameraOnRobot(const mrpt::obs::CObservation3DRangeScan& scan);

/// What the robot did that carries the camera: T_start_robot (x forward, y left, z up) at every pose of the
/// camera's trajectory; start is the robot when the camera was at the origin of its trajectory, at the time
/// of the first mount.
/// @param mounts  T_robot_camera by time, at least one; a pose takes that of its own stamp or the last before
std::vector<StampedPose> robotTrajectory(const std::vector<StampedPose>& camera_trajectory,
                                         const std::vector<StampedPose>& mounts);

}  // namespace roevo
