#pragma once
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder is a sequence of the ETH3D SLAM benchmark: calibration.txt beside a list of images,
/// or its associated.txt where no camera is known by which TUM's reader would read it.
bool isEth3dFolder(const std::string& folder);

/// Reads an ETH3D SLAM sequence: calibration.txt ("fx fy cx cy"; the size is that of the images), pairs from
/// associated.txt or else matched from rgb.txt and depth.txt, groundtruth.txt and imu.txt where there are
/// any. Depth is in 1/5000 m. A camera.txt overrides calibration and depth scale.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadEth3d(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
