#pragma once
/// What lies beside a dataset's images: trajectories and inertial measurements. A fault in them does not make
/// the images unusable, so it is noted and not thrown.

#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// A TUM trajectory of the colour camera as it is; empty when there is no such file, empty with a note when
/// it cannot be used.
GroundTruth readGroundTruth(const std::string& file);

/// One that was asked for: a trajectory of any format. @throws std::runtime_error where it is no good
GroundTruth readNamedGroundTruth(const std::string& file);

/// TUM's accelerometer.txt ("timestamp ax ay az", m/s^2) into `out.imu` and `out.imu_source`; nothing when
/// there is no such file. Lines that cannot be used are left out, counted and the first one named.
void readAccelerometer(const std::string& file, DatasetDescription& out);

/// ETH3D's imu.txt ("timestamp", then angular velocity in rad/s and acceleration in m/s^2), as
/// readAccelerometer(). Which three columns are the acceleration is told by gravity.
void readImu(const std::string& file, DatasetDescription& out);

}  // namespace roevo
