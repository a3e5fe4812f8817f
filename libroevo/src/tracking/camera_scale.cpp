#include "tracking/camera_scale.h"

#include <algorithm>
#include <cmath>

namespace roevo {
namespace {

/// px, one sigma, of what a 640 pixels wide camera's pixel and Sobel's filter average over. An edge found
/// over less of the scene is one of noise and rounding, in crooked pieces.
constexpr double kAperture = 0.9;

}  // namespace

OdometryOptions scaledTo(const PinholeCamera& camera, OdometryOptions options) {
    // Noise of pixels does not shrink with the image: smaller ones keep the numbers
    const double motion = std::max(1.0, camera.pixelScale()), sampling = std::max(1.0, camera.width / 640.);
    options.fine.search_radius *= motion;
    options.fine.final_radius *= motion;
    const auto points = [&](int count) { return static_cast<int>(std::lround(sampling * count)); };
    options.edges.min_length = points(options.edges.min_length);
    options.edges.tangent_span = points(options.edges.tangent_span);
    options.edges.depth_patch_radius = points(options.edges.depth_patch_radius);
    const double finer = kAperture * std::sqrt(sampling * sampling - 1);
    options.edges.blur_sigma = std::hypot(options.edges.blur_sigma, finer);
    options.coarse.levels += static_cast<int>(std::lround(std::log2(sampling)));
    return options;
}

}  // namespace roevo
