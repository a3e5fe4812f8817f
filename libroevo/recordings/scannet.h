#pragma once
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder is a scene of ScanNet as its SensReader exports it: color/, depth/ and intrinsic/.
bool isScanNetFolder(const std::string& folder);

/// Reads such a scene: color/N.jpg, depth/N.png (mm), pose/N.txt (4x4, camera to world; -inf where there is
/// none), N at 30 Hz, intrinsic/intrinsic_color.txt and intrinsic_depth.txt (4x4). Depth has a camera of its
/// own, in the same place. A camera that is given (givenCamera()) overrides this.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadScanNet(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
