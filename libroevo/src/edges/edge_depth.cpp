#include "edges/edge_depth.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "pixels/nearest.h"
#include "pixels/pixel_kernels.h"

namespace roevo {
namespace {

constexpr int kMaxRadius = 15;
constexpr int kMostAcross = 5;             ///< pixels to each side; of larger patches every n-th is looked at
constexpr std::size_t kMinForeground = 3;  ///< fewer near pixels are speckle
/// Position relative to the patch's origin, inverse depth, and nothing.
typedef float Sample __attribute__((vector_size(16)));

/// Inverse depth at the patch's origin of the least-squares plane 1/z = a + b dx + c dy, or of the mean where
/// the samples do not span a plane.
float planeAtOrigin(const Sample* samples, int count) {
    Sample sum{};
    for (int i = 0; i < count; ++i) sum += samples[i];
    const auto n = static_cast<float>(count);
    const Sample mean = sum * (1 / n);
    Sample squares{}, by_inverse{};  // xx xy yy, and xq yq
    for (int i = 0; i < count; ++i) {
        const Sample d = samples[i] - mean;
        squares += __builtin_shufflevector(d, d, 0, 0, 1, 3) * __builtin_shufflevector(d, d, 0, 1, 1, 3);
        by_inverse += d * d[2];
    }
    const float xx = squares[0], xy = squares[1], yy = squares[2], xq = by_inverse[0], yq = by_inverse[1];
    const float determinant = xx * yy - xy * xy;
    if (count < 6 || determinant < 0.05F * static_cast<float>(count * count)) return mean[2];
    const float b = (xq * yy - yq * xy) / determinant, c = (yq * xx - xq * xy) / determinant;
    return mean[2] - b * mean[0] - c * mean[1];
}

/// A depth that is not negative and the pixel it is of, as a number that orders by depth, then row, then
/// column.
std::uint64_t keyOf(float z, int x, int y) {
    std::uint32_t bits;
    std::memcpy(&bits, &z, sizeof bits);
    return std::uint64_t{bits} << 32 | static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
}

float depthOf(std::uint64_t key) {
    const auto bits = static_cast<std::uint32_t>(key >> 32);
    float z;
    std::memcpy(&z, &bits, sizeof z);
    return z;
}

/// A square of depths around pixel (x, y).
struct Square {
    int x, y, radius;
};

struct Limits {
    float near, far;  ///< m, of depths that are used
    float jump;       ///< factor between depths of two surfaces
};

/// The depth at the edge of a surface whose inverse depth there is this. The edge is up to a pixel past the
/// last near sample, and sometimes only two columns of them are in the patch. Kept within their range, the
/// far end of whatever recedes came out too near, and a camera that moves forward moved too little.
float depthAtEdge(float inverse, float nearest, float farthest, const Limits& limits) {
    const float range = farthest - nearest;
    return std::clamp(inverse > 0 ? 1 / inverse : farthest, std::max(nearest - range, limits.near),
                      std::min(farthest + range, limits.far));
}

/// Of a square that may lie partly outside and show several surfaces.
EdgeDepth nearestSurface(const cv::Mat& depth, const Square& square, float u, float v, const Limits& limits) {
    const int radius = square.radius;
    const int step = std::max(1, (radius + kMostAcross - 1) / kMostAcross);
    constexpr std::size_t kMostSamples = (2 * kMaxRadius + 1) * (2 * kMaxRadius + 1);
    std::array<std::uint64_t, kMostSamples> keys;
    std::size_t count = 0;
    for (int y = std::max(0, square.y - radius); y <= std::min(depth.rows - 1, square.y + radius);
         y += step) {
        const auto* row = depth.ptr<float>(y);
        for (int x = std::max(0, square.x - radius); x <= std::min(depth.cols - 1, square.x + radius);
             x += step) {
            const float z = row[x];
            if (z >= limits.near && z <= limits.far) keys[count++] = keyOf(z, x, y);
        }
    }
    if (count < kMinForeground) return {};
    const auto [least, most] = std::minmax_element(keys.begin(), keys.begin() + count);
    EdgeDepth result;
    std::size_t begin = 0, end = count;
    float nearest = depthOf(*least), farthest = depthOf(*most);
    if (farthest > nearest * limits.jump) {
        std::sort(keys.begin(), keys.begin() + count);
        end = 1;
        while (end < count) {
            if (depthOf(keys[end]) > depthOf(keys[end - 1]) * limits.jump) {
                if (end - begin >= kMinForeground) break;
                begin = end;  // speckle in front of everything else
            }
            ++end;
        }
        if (end - begin < kMinForeground) return {};
        nearest = depthOf(keys[begin]);
        farthest = depthOf(keys[end - 1]);
        result.occluding = end < count;
    }
    std::array<Sample, kMostSamples> samples;
    for (std::size_t i = begin; i < end; ++i)
        samples[i - begin] = Sample{static_cast<float>(keys[i] & 0xFFFF) - u,
                                    static_cast<float>(keys[i] >> 16 & 0xFFFF) - v, 1 / depthOf(keys[i]), 0};
    result.depth =
        depthAtEdge(planeAtOrigin(samples.data(), static_cast<int>(end - begin)), nearest, farthest, limits);
    return result;
}

}  // namespace

EdgeDepth foregroundDepth(const cv::Mat& depth, float u, float v, const EdgeOptions& edges,
                          const SensorOptions& sensor) {
    const Square square{nearestInteger(static_cast<double>(u)), nearestInteger(static_cast<double>(v)),
                        std::min(edges.depth_patch_radius, kMaxRadius)};
    const Limits limits{static_cast<float>(sensor.min_depth), static_cast<float>(sensor.depth_limit),
                        1 + static_cast<float>(edges.depth_jump)};
    // Most squares lie inside and show one surface
    const int left = square.x - square.radius, top = square.y - square.radius, size = 2 * square.radius + 1;
    if (size <= pixels::kMostPatch && left >= 0 && top >= 0 && left + pixels::kMostPatch < depth.cols &&
        top + size <= depth.rows) {
        pixels::DepthPatch patch;
        pixels::best().depthPatch(depth.ptr<float>(top) + left,
                                  static_cast<std::ptrdiff_t>(depth.step[0] / sizeof(float)), size,
                                  limits.near, limits.far, limits.jump, u - static_cast<float>(square.x),
                                  v - static_cast<float>(square.y), patch);
        if (patch.count < static_cast<int>(kMinForeground)) return {};
        if (patch.farthest <= patch.nearest * limits.jump)
            return {depthAtEdge(patch.inverse, patch.nearest, patch.farthest, limits), false};
    }
    return nearestSurface(depth, square, u, v, limits);
}

}  // namespace roevo
