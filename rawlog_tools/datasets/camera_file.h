#pragma once
#include <optional>
#include <string>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// What is known of a dataset's camera, and from where.
struct CameraDescription {
    PinholeCamera camera;
    double depth_scale = 5000;  ///< PNG units per metre
    std::string source;         ///< in words, for the log
};

/// Reads camera.txt: "key: value" lines with optional '# …' at the end; keys width, height, fx, fy, cx, cy,
/// distortion_k1_k2_p1_p2_k3 (five numbers; absent = none) and depth_scale. Other keys are notes.
/// @throws std::runtime_error naming file, line and what is wrong or missing.
CameraDescription readCameraFile(const std::string& file);

/// The published camera of a TUM RGB-D sequence if `text` (a folder name or a list's header) names freiburg1,
/// 2 or 3.
std::optional<CameraDescription> tumCameraNamedIn(const std::string& text);

}  // namespace roevo
