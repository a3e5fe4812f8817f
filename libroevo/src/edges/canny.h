#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/gradient.h"
#include "roevo/options.h"

namespace roevo {

/// Edge mask and the linear indices (y * width + x) of its pixels in raster order. Reusable buffers.
struct EdgeMask {
    cv::Mat mask;  ///< CV_8UC1: 1 on these pixels, 0 elsewhere; the outermost kBorder pixels are always 0
    std::vector<std::int32_t> pixels;
    // Buffers
    std::vector<std::uint64_t> strong{}, weak{};  ///< of canny(): a bit for each pixel
    std::vector<std::int32_t> corners{};          ///< of adjustAdjacency()

    static constexpr int kBorder =
        4;  ///< px without edges, so that patches and neighbours never leave the image
};

/// Of the gradient magnitude, Sobel units; low <= high.
struct CannyThresholds {
    double low = 0, high = 0;
};
/// As the options have them for an image: relative to Otsu's, with a floor.
CannyThresholds cannyThresholds(const Gradient& gradient, const EdgeOptions& options);

/// Canny's non-maximum suppression and hysteresis (8 neighbours) on a gradient. Linear in the number of
/// pixels.
void canny(const Gradient& gradient, const CannyThresholds& thresholds, EdgeMask& out);

}  // namespace roevo
