#include "edges/edge_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pixels/pixel_kernels.h"

namespace roevo {
namespace {

constexpr int kMaxRadius = 15;
constexpr int kMostAcross = 5;     ///< pixels to each side; of larger patches every n-th is looked at
constexpr int kMinForeground = 3;  ///< fewer near pixels are speckle
struct Sample {
    float z, inverse, dx, dy;
};

/// Inverse depth at the patch's origin of the least-squares plane 1/z = a + b dx + c dy, or of the mean where
/// the samples do not span a plane.
float planeAtOrigin(const Sample* samples, int count) {
    float sum_x = 0, sum_y = 0, sum_q = 0;
    for (int i = 0; i < count; ++i) {
        sum_x += samples[i].dx;
        sum_y += samples[i].dy;
        sum_q += samples[i].inverse;
    }
    const float scale = 1 / static_cast<float>(count);
    const float mx = sum_x * scale, my = sum_y * scale, mq = sum_q * scale;
    float xx = 0, xy = 0, yy = 0, xq = 0, yq = 0;
    for (int i = 0; i < count; ++i) {
        const float dx = samples[i].dx - mx, dy = samples[i].dy - my, dq = samples[i].inverse - mq;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
        xq += dx * dq;
        yq += dy * dq;
    }
    const float determinant = xx * yy - xy * xy;
    if (count < 6 || determinant < 0.05F * static_cast<float>(count * count)) return mq;
    const float b = (xq * yy - yq * xy) / determinant, c = (yq * xx - xq * xy) / determinant;
    return mq - b * mx - c * my;
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
    std::array<Sample, (2 * kMaxRadius + 1) * (2 * kMaxRadius + 1)> samples;
    int count = 0;
    float nearest = limits.far, farthest = limits.near;
    for (int y = std::max(0, square.y - radius); y <= std::min(depth.rows - 1, square.y + radius);
         y += step) {
        const auto* row = depth.ptr<float>(y);
        for (int x = std::max(0, square.x - radius); x <= std::min(depth.cols - 1, square.x + radius);
             x += step) {
            const float z = row[x];
            if (!(z >= limits.near && z <= limits.far)) continue;
            samples[static_cast<std::size_t>(count++)] = {z, 1 / z, static_cast<float>(x) - u,
                                                          static_cast<float>(y) - v};
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
        }
    }
    if (count < kMinForeground) return {};
    EdgeDepth result;
    int begin = 0, end = count;
    if (farthest > nearest * limits.jump) {
        std::sort(samples.begin(), samples.begin() + count, [](const Sample& a, const Sample& b) {
            return a.z != b.z ? a.z < b.z : (a.dy != b.dy ? a.dy < b.dy : a.dx < b.dx);
        });
        end = 1;
        while (end < count) {
            if (samples[static_cast<std::size_t>(end)].z >
                samples[static_cast<std::size_t>(end) - 1].z * limits.jump) {
                if (end - begin >= kMinForeground) break;
                begin = end;  // speckle in front of everything else
            }
            ++end;
        }
        if (end - begin < kMinForeground) return {};
        nearest = samples[static_cast<std::size_t>(begin)].z;
        farthest = samples[static_cast<std::size_t>(end) - 1].z;
        result.occluding = end < count;
    }
    result.depth = depthAtEdge(planeAtOrigin(samples.data() + begin, end - begin), nearest, farthest, limits);
    return result;
}

}  // namespace

EdgeDepth foregroundDepth(const cv::Mat& depth, float u, float v, const EdgeOptions& edges,
                          const SensorOptions& sensor) {
    const Square square{static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v)),
                        std::min(edges.depth_patch_radius, kMaxRadius)};
    const Limits limits{static_cast<float>(sensor.min_depth), static_cast<float>(sensor.depth_limit),
                        1 + static_cast<float>(edges.depth_jump)};
    // Most squares lie inside and show one surface
    const int left = square.x - square.radius, top = square.y - square.radius, size = 2 * square.radius + 1;
    if (size <= pixels::kMostPatch && left >= 0 && top >= 0 && left + pixels::kMostPatch < depth.cols &&
        top + size <= depth.rows) {
        pixels::DepthPatch patch;
        pixels::best().depthPatch(depth.ptr<float>(top) + left, static_cast<std::ptrdiff_t>(depth.step1()),
                                  size, limits.near, limits.far, limits.jump,
                                  u - static_cast<float>(square.x), v - static_cast<float>(square.y), patch);
        if (patch.count < kMinForeground) return {};
        if (patch.farthest <= patch.nearest * limits.jump)
            return {depthAtEdge(patch.inverse, patch.nearest, patch.farthest, limits), false};
    }
    return nearestSurface(depth, square, u, v, limits);
}

}  // namespace roevo
