#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/gradient.h"

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

/// Canny's non-maximum suppression and hysteresis (8 neighbours) on a gradient. Linear in the number of
/// pixels.
/// @param low, high  thresholds on the gradient magnitude, Sobel units, low <= high
void canny(const Gradient& gradient, double low, double high, EdgeMask& out);

}  // namespace roevo
