#pragma once
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder has a folder of colour images (rgb, color, colour, images) and one of depth images
/// (depth), without lists.
bool isPlainFolder(const std::string& folder);

/// Reads a pair of folders whose images have the same names, and camera.txt; pairByName() tells the times,
/// for which camera.txt may have a frame_rate. A groundtruth.txt in TUM form is taken along.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadPlain(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
