#pragma once
#include <string>

#include "recordings/dataset_reader.h"
#include "recordings/numbered_files.h"

namespace roevo {

/// Images of both kinds, as a folder without lists has them.
struct ImagePair {
    NamedImages colour, depth;
    std::string colour_place, depth_place;  ///< where they are: a folder
};

/// A folder of colour images (rgb, color, colour, images, …) and one of depth images (depth, …) in it, in
/// large or small letters; or images of both kinds side by side, of which those of depth say so in their
/// names. Nothing where one kind is missing.
std::optional<ImagePair> findImages(const std::string& folder);

/// Whether the folder has images of both kinds.
bool isPlainFolder(const std::string& folder);

/// Reads such a folder, and its camera (givenCamera()); pairByName() tells the times, for which the camera
/// may have a frame_rate. A groundtruth.txt in TUM form is taken along.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadPlain(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
