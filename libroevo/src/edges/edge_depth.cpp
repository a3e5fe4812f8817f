#include "edges/edge_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "indexing.h"
#include "nearest.h"

namespace roevo {
namespace {

constexpr int kMost = kernels::kMostPatch;
constexpr int kMostSparse = 7;     ///< px, radius of a square where few depths are known
constexpr int kMinForeground = 3;  ///< fewer near pixels are speckle
constexpr std::array<float, 2 * kMost + 1> kSteps = {-7, -6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7};

/// The depth at the edge of a surface. The edge is up to a pixel past the last near sample, and sometimes
/// only two columns of them are in the patch. Kept within their range, the far end of whatever recedes came
/// out too near, and a camera that moves forward moved too little.
float depthAtEdge(const kernels::DepthPatch& patch, const kernels::DepthLimits& limits) {
    const float range = patch.farthest - patch.nearest;
    return std::clamp(patch.inverse > 0 ? 1 / patch.inverse : patch.farthest,
                      std::max(patch.nearest - range, limits.near),
                      std::min(patch.farthest + range, limits.far));
}

/// Around known depths, the share of depths that are known; 1 where none is.
double densityOf(const cv::Mat& depth) {
    constexpr int kLooks = 2000, kEnoughFound = 40, kReach = 5;
    std::minstd_rand random;  // known depths may lie in a grid
    int found = 0, looked_at = 0, known = 0;
    for (int k = 0; k < kLooks && found < kEnoughFound && !depth.empty(); ++k) {
        const int row = static_cast<int>(random() % static_cast<unsigned>(depth.rows));
        const int column = static_cast<int>(random() % static_cast<unsigned>(depth.cols));
        if (!(depth.at<float>(row, column) > 0)) continue;
        ++found;
        for (int v = std::max(0, row - kReach); v <= std::min(row + kReach, depth.rows - 1); ++v) {
            for (int u = std::max(0, column - kReach); u <= std::min(column + kReach, depth.cols - 1); ++u) {
                ++looked_at;
                known += depth.at<float>(v, u) > 0 ? 1 : 0;
            }
        }
    }
    return found > 0 ? static_cast<double>(known) / looked_at : 1;
}

/// Radius of squares that hold enough known depths on both sides of an edge, px; 0 where depth is not sparse.
int sparseRadius(double density) {
    constexpr double kSparse = 0.35, kEnough = 16;
    if (density > kSparse) return 0;
    return std::min(kMostSparse, static_cast<int>(std::ceil((std::sqrt(kEnough / density) - 1) / 2)));
}

}  // namespace

/// The rows (columns) of a square that are looked at.
struct ForegroundDepth::Offsets {
    std::array<int, kMost> from_centre{};  // px
    int count = 0;

    /// Of those that are known, at most kMost, spread over all.
    static Offsets known(const std::array<bool, 2 * kMostSparse + 1>& is_known, int radius) {
        std::array<int, 2 * kMostSparse + 1> all{};
        int number = 0;
        for (int k = 0; k <= 2 * radius; ++k)
            if (roevo::at(is_known, k)) roevo::at(all, number++) = k - radius;
        Offsets some;
        some.count = std::min(number, kMost);
        for (int k = 0; k < some.count; ++k)
            roevo::at(some.from_centre, k) = roevo::at(all, k * number / some.count);
        return some;
    }
    /// At most kMost, spread over a square of this radius.
    static Offsets spread(int radius) {
        Offsets some;
        const int half = std::min(radius, kMost / 2);
        some.count = 2 * half + 1;
        for (int k = 0; k < some.count; ++k) roevo::at(some.from_centre, k) = (k - half) * radius / half;
        return some;
    }
};

/// What the kernel looks at where it cannot look at the image itself.
struct ForegroundDepth::Copy {
    std::array<float, kMost*(kMost + 1)> depths{};
    std::array<float, kMost + 1> rows{}, columns{};
};

ForegroundDepth::ForegroundDepth(const cv::Mat& depth, const EdgeOptions& edges, const SensorOptions& sensor)
    : depth_(depth),
      limits_{static_cast<float>(sensor.min_depth), static_cast<float>(sensor.depth_limit),
              1 + static_cast<float>(edges.depth_jump), kMinForeground},
      radius_(edges.depth_patch_radius) {
    const int needed = sparseRadius(densityOf(depth));
    sparse_ = needed > 0;
    if (sparse_) radius_ = std::min(std::max(needed, radius_), kMostSparse);
}

void ForegroundDepth::lookForKnown(int x, int y, Offsets& rows, Offsets& columns) const {
    std::array<bool, 2 * kMostSparse + 1> row_known{}, column_known{};
    const int top = std::max(-radius_, -y), bottom = std::min(radius_, depth_.rows - 1 - y);
    const int left = std::max(-radius_, -x), right = std::min(radius_, depth_.cols - 1 - x);
    for (int v = top; v <= bottom; ++v) {
        const float* const row = depth_.ptr<float>(y + v);
        for (int u = left; u <= right; ++u) {
            if (!(row[x + u] > 0)) continue;
            roevo::at(row_known, v + radius_) = roevo::at(column_known, u + radius_) = true;
        }
    }
    rows = Offsets::known(row_known, radius_);
    columns = Offsets::known(column_known, radius_);
}

/// Across a border, of a large square only some pixels, or where few are known.
kernels::DepthSquare ForegroundDepth::copy(int x, int y, Copy& to) const {
    Offsets rows = Offsets::spread(radius_), columns = rows;
    if (sparse_) lookForKnown(x, y, rows, columns);
    for (int c = 0; c < columns.count; ++c)
        roevo::at(to.columns, c) = static_cast<float>(roevo::at(columns.from_centre, c));
    for (int r = 0; r < rows.count; ++r) {
        const int v = roevo::at(rows.from_centre, r), row = y + v;
        roevo::at(to.rows, r) = static_cast<float>(v);
        for (int c = 0; c < columns.count; ++c) {
            const int column = x + roevo::at(columns.from_centre, c);
            if (row >= 0 && row < depth_.rows && column >= 0 && column < depth_.cols)
                roevo::at(to.depths, r * (kMost + 1) + c) = depth_.at<float>(row, column);
        }
    }
    return {to.depths.data(), kMost + 1, std::max(rows.count, columns.count), to.columns.data(),
            to.rows.data()};
}

float ForegroundDepth::at(float u, float v) const {
    if (depth_.empty()) return 0;
    const int x = nearestInteger(u), y = nearestInteger(v);
    const int size = 2 * radius_ + 1, left = x - radius_, top = y - radius_;
    const bool is_inside = left >= 0 && top >= 0 && left + kMost < depth_.cols && top + size <= depth_.rows;
    kernels::DepthPatch patch;
    const auto look = [&](const kernels::DepthSquare& square) {
        kernels::best().depthPatch(square, limits_, u - static_cast<float>(x), v - static_cast<float>(y),
                                   patch);
    };
    if (!sparse_ && size <= kMost && is_inside) {
        const float* const offsets = kSteps.data() + kMost - radius_;
        look({depth_.ptr<float>(top) + left, static_cast<std::ptrdiff_t>(depth_.step1()), size, offsets,
              offsets});
    } else {
        Copy copied;
        look(copy(x, y, copied));
    }
    return patch.count > 0 ? depthAtEdge(patch, limits_) : 0;
}

}  // namespace roevo
