#pragma once
#include <optional>
#include <string>

#include "recordings/camera_file.h"

namespace roevo {

/// Whether a file's name speaks for a calibration: .yaml, .yml, .json, or Record3D's "metadata"; not that of
/// a depth or infrared camera.
bool mayBeCalibration(const std::string& file);

/// What a camera can be checked as before its images tell their size: one whose principal point is their
/// middle. Itself where it has a size.
PinholeCamera asIfCentred(PinholeCamera camera);

/// The colour camera in a file of ROS (camera_info as YAML, or a message that was printed), ORB-SLAM, Kalibr,
/// Open3D, RealSense, Record3D and whatever else has fx, fy, cx, cy or a 3x3 matrix under usual names, at its
/// top or in a part that is named after the camera. A size of 0 and a depth scale of 0: not told.
/// @return nothing where there is no camera in it
/// @throws std::runtime_error naming the file: it is named after a camera and cannot be read, or its camera
/// is none
std::optional<CameraDescription> readCalibrationFile(const std::string& file);

}  // namespace roevo
