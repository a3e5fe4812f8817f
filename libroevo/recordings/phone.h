#pragma once
/// Recordings of iPhones and iPads with a lidar: depth is of the colour camera's view, but smaller, and the
/// poses are those of ARKit.

#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder is one of Stray Scanner: camera_matrix.csv and odometry.csv.
bool isStrayFolder(const std::string& folder);

/// Reads depth/N.png (mm), and rgb/N.png or .jpg, which are to be taken out of rgb.mp4 first; times and poses
/// are in odometry.csv, the intrinsics of colour in camera_matrix.csv.
/// @throws std::runtime_error naming the file and the fault; with a mere rgb.mp4, the command that unpacks it
DatasetDescription loadStray(const std::string& folder, const DatasetOptions& options);

/// Whether the folder is one of Record3D ("EXR and JPG sequence"): rgb/, depth/ and metadata or
/// metadata.json.
bool isRecord3dFolder(const std::string& folder);

/// Reads rgb/N.jpg and depth/N.exr (m) at the rate of the metadata, which have intrinsics and poses, too.
/// @throws std::runtime_error naming the file and the fault
DatasetDescription loadRecord3d(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
