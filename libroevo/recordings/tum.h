#pragma once
#include <optional>
#include <string>

#include "recordings/camera_file.h"
#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder has the lists of a TUM RGB-D sequence (rgb.txt or depth.txt or associations.txt).
bool isTumFolder(const std::string& folder);

/// The camera that is given (givenCamera()), else that of the freiburg1, 2 or 3 sequence which the folder's
/// name or a list's header names. @throws std::runtime_error for a given one that cannot be used
std::optional<CameraDescription> findTumCamera(const std::string& folder, const FolderChoice& choice = {});

/// Reads the lists of a TUM RGB-D sequence and matches colour and depth one to one. Intrinsics are
/// given or, for the benchmark's own sequences, from the published calibration that the folder's name or
/// the lists' headers point to.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadTum(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
