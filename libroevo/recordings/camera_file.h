#pragma once
#include <optional>
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// What is known of a dataset's camera, and from where.
struct CameraDescription {
    PinholeCamera camera;
    double depth_scale = 5000;         ///< PNG units per metre
    std::optional<double> frame_rate;  ///< Hz, where the file tells it
    std::string source;                ///< in words, for the log
};

/// Reads camera.txt: "key: value" lines with optional '# …' at the end; keys width, height, fx, fy, cx, cy,
/// distortion_k1_k2_p1_p2_k3 (five numbers; absent = none), depth_scale and, optional, frame_rate. Other keys
/// are notes.
/// @throws std::runtime_error naming file, line and what is wrong or missing.
CameraDescription readCameraFile(const std::string& file);

/// What such a file says of a camera, for readCameraFile() to read the same numbers.
/// @param notes   lines for people, "key: value"
/// @param number  writes a number with all the digits that it needs
std::string cameraFileText(const PinholeCamera& camera, double depth_scale,
                           const std::vector<std::string>& notes, std::string (*number)(double));

/// The published camera of a TUM RGB-D sequence if `text` (a folder name or a list's header) names freiburg1,
/// 2 or 3.
std::optional<CameraDescription> tumCameraNamedIn(const std::string& text);

/// Puts a camera into the description of a dataset.
void setCamera(const CameraDescription& camera, DatasetDescription& out);

/// camera.txt of the folder if it has one: whatever a layout prescribes, that file is the user's word.
std::optional<CameraDescription> cameraFileIn(const std::string& folder);

}  // namespace roevo
