#pragma once
#include <optional>
#include <string>

#include "recordings/camera_file.h"
#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder has the lists of a TUM RGB-D sequence (rgb.txt or depth.txt or associations.txt).
bool isTumFolder(const std::string& folder);

/// The camera of camera.txt, else that of the freiburg1, 2 or 3 sequence which the folder's name or a list's
/// header names. @throws std::runtime_error for a camera.txt that cannot be used
std::optional<CameraDescription> findTumCamera(const std::string& folder);

/// Reads the lists of a TUM RGB-D sequence and matches colour and depth one to one. Intrinsics come from
/// camera.txt or, for the benchmark's own sequences, from the published calibration that the folder's name or
/// the lists' headers point to.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadTum(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
