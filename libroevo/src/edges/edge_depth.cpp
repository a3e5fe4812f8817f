#include "edges/edge_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "indexing.h"
#include "pixels/nearest.h"
#include "pixels/pixel_kernels.h"

namespace roevo {
namespace {

constexpr int kMost = pixels::kMostPatch;
constexpr int kMinForeground = 3;  ///< fewer near pixels are speckle
constexpr std::array<float, 2 * kMost + 1> kSteps = {-7, -6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7};

/// The depth at the edge of a surface. The edge is up to a pixel past the last near sample, and sometimes
/// only two columns of them are in the patch. Kept within their range, the far end of whatever recedes came
/// out too near, and a camera that moves forward moved too little.
float depthAtEdge(const pixels::DepthPatch& patch, const pixels::DepthLimits& limits) {
    const float range = patch.farthest - patch.nearest;
    return std::clamp(patch.inverse > 0 ? 1 / patch.inverse : patch.farthest,
                      std::max(patch.nearest - range, limits.near),
                      std::min(patch.farthest + range, limits.far));
}

}  // namespace

float foregroundDepth(const cv::Mat& depth, float u, float v, const EdgeOptions& edges,
                      const SensorOptions& sensor) {
    const int radius = edges.depth_patch_radius, half = std::min(radius, kMost / 2), size = 2 * half + 1;
    const int x = nearestInteger(static_cast<double>(u)), y = nearestInteger(static_cast<double>(v));
    const pixels::DepthLimits limits{static_cast<float>(sensor.min_depth),
                                     static_cast<float>(sensor.depth_limit),
                                     1 + static_cast<float>(edges.depth_jump), kMinForeground};
    const int left = x - radius, top = y - radius;
    pixels::DepthSquare square{nullptr, static_cast<std::ptrdiff_t>(depth.step1()), size,
                               kSteps.data() + kMost - half};
    std::array<float, kMost + 1> offsets{};
    std::array<float, kMost*(kMost + 1)> samples;
    if (radius == half && left >= 0 && top >= 0 && left + kMost < depth.cols && top + size <= depth.rows) {
        square.depth = depth.ptr<float>(top) + left;
    } else {  // across a border, or of a large square only some pixels
        samples.fill(0);
        const auto offset = [&](int k) { return (k - half) * radius / half; };
        for (int r = 0; r < size; ++r) {
            const int row = y + offset(r);
            at(offsets, r) = static_cast<float>(offset(r));
            for (int c = 0; c < size; ++c) {
                const int column = x + offset(c);
                if (row >= 0 && row < depth.rows && column >= 0 && column < depth.cols)
                    at(samples, r * (kMost + 1) + c) = depth.at<float>(row, column);
            }
        }
        square.offsets = offsets.data();
        square.depth = samples.data();
        square.stride = kMost + 1;
    }
    pixels::DepthPatch patch;
    pixels::best().depthPatch(square, limits, u - static_cast<float>(x), v - static_cast<float>(y), patch);
    return patch.count > 0 ? depthAtEdge(patch, limits) : 0;
}

}  // namespace roevo
