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
    double depth_scale = 5000;                      ///< units per metre; 0: not told
    std::optional<double> frame_rate;               ///< Hz, where the file tells it
    std::string source;                             ///< in words, for the log
    std::optional<DepthRegistration> registration;  ///< where depth has a camera of its own
    std::vector<std::string> notes;                 ///< of how the source was chosen, a line each
};

/// Reads camera.txt: "key: value" lines with optional '# …' at the end; keys width, height, fx, fy, cx, cy,
/// depth_scale and, optional, the lens as distortion_k1_k2_p1_p2_k3, distortion_k1_k2_p1_p2_k3_k4_k5_k6 or
/// fisheye_k1_k2_k3_k4, frame_rate, and a depth camera of its own: depth_width, depth_height, depth_fx, …, a
/// lens with depth_ before its key, and depth_to_colour: its pose in the colour camera, "x y z qx qy qz qw"
/// (m; absent: the same place). Other keys are notes.
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

}  // namespace roevo
