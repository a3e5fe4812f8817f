#pragma once
#include <optional>
#include <string>

#include "recordings/camera_file.h"
#include "recordings/dataset_reader.h"
#include "recordings/folder_choice.h"

namespace roevo {

/// What the user says of the camera, whatever a layout prescribes: on the command line; else camera.txt; else
/// the calibration files of other programs in the folder (readCalibrationFile()), which must agree. Nothing
/// where there is none of them. A size of 0 is that of the images.
/// @throws std::runtime_error naming the file and what is wrong with it, or two files that differ
std::optional<CameraDescription> givenCamera(const std::string& folder, const FolderChoice& choice);

/// Hz, of images that are numbered: as chosen, else as the camera's file says, else the usual one.
double frameRate(const FolderChoice& choice, const std::optional<CameraDescription>& camera, double usual);

/// Puts a camera into the description of a dataset whose frames are known.
/// @throws std::runtime_error when it cannot be one
void setCamera(const CameraDescription& camera, DatasetDescription& out);

/// The error where none is given, with what to do. @param layout  what was looked for beside, or ""
std::string noIntrinsics(const std::string& folder, const std::string& layout = "");

}  // namespace roevo
