#pragma once
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace roevo {

/// What a user says of a folder of images, where that is not in the folder or wrong there. Whatever is empty
/// or 0 was not said.
struct FolderChoice {
    std::string associations;        ///< file of pairs, "time colour time depth" a line
    std::vector<double> intrinsics;  ///< fx fy cx cy, pixels
    std::vector<double> distortion;  ///< k1 k2 p1 p2 [k3 [k4 k5 k6]]
    std::vector<double> fisheye;     ///< k1 k2 k3 k4 of a Kannala-Brandt lens
    double depth_scale = 0;          ///< units per metre of the depth images
    double frame_rate = 0;           ///< Hz, of images that are numbered

    /// The options that were given, with their values, as a command line has them.
    std::vector<std::pair<std::string, std::string>> options() const;

    /// @throws std::runtime_error (of programs: UsageError) naming the option, for numbers that are too few,
    /// too many or negative, and when it contradicts itself
    void check() const;
};

/// The options --associations, --intrinsics, --distortion, --fisheye, --depth-scale and --frame-rate.
void addFolderOptions(CLI::App& app, FolderChoice& choice);

}  // namespace roevo
