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
constexpr int kMostSparse = 15;  ///< px, side of a square where few depths are known
constexpr int kLeastSparse = 3;  ///< depths; there, fewer near ones are speckle
constexpr int kLeastShare = 8;   ///< elsewhere, less than one in so many
constexpr std::array<float, kMost> kSteps = {0, 1, 2, 3, 4, 5, 6, 7};

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

/// Side of squares that hold enough known depths on both sides of an edge, px; 0 where depth is not sparse.
int sparseSide(double density) {
    constexpr double kSparse = 0.35, kEnough = 16;
    if (density > kSparse) return 0;
    return std::min(kMostSparse, 2 * static_cast<int>(std::ceil((std::sqrt(kEnough / density) - 1) / 2)) + 1);
}

/// Where a square of this side around a coordinate begins, px.
int beginOf(float centre, int side) {
    return nearestInteger(static_cast<double>(centre) - (side - 1) / 2.0);
}

}  // namespace

/// The rows (columns) of a square that are looked at.
struct ForegroundDepth::Offsets {
    std::array<int, kMost> from_first{};  // px
    int count = 0;

    /// Of those that are known, at most kMost, spread over all.
    static Offsets known(const std::array<bool, kMostSparse>& is_known, int side) {
        std::array<int, kMostSparse> all{};
        int number = 0;
        for (int k = 0; k < side; ++k)
            if (roevo::at(is_known, k)) roevo::at(all, number++) = k;
        Offsets some;
        some.count = std::min(number, kMost);
        for (int k = 0; k < some.count; ++k)
            roevo::at(some.from_first, k) = roevo::at(all, k * number / some.count);
        return some;
    }
    /// At most kMost, spread over a square of this side.
    static Offsets spread(int side) {
        Offsets some;
        some.count = std::min(side, kMost);
        for (int k = 0; k < some.count; ++k)
            roevo::at(some.from_first, k) = k * (side - 1) / std::max(1, some.count - 1);
        return some;
    }
};

/// What the kernel looks at where it cannot look at the image itself.
struct ForegroundDepth::Copy {
    std::array<float, kMost * kMost> depths{};
    std::array<float, kMost> rows{}, columns{};
};

ForegroundDepth::ForegroundDepth(const cv::Mat& depth, const EdgeOptions& edges, const SensorOptions& sensor)
    : depth_(depth), side_(edges.depth_patch) {
    const int needed = sparseSide(densityOf(depth));
    sparse_ = needed > 0;
    if (sparse_) side_ = std::min(std::max(needed, side_), kMostSparse);
    const int looked_at = std::min(side_, kMost);
    limits_ = {static_cast<float>(sensor.min_depth), static_cast<float>(sensor.depth_limit),
               1 + static_cast<float>(edges.depth_jump),
               sparse_ ? kLeastSparse : std::max(kLeastSparse, looked_at * looked_at / kLeastShare)};
}

void ForegroundDepth::lookForKnown(int left, int top, Offsets& rows, Offsets& columns) const {
    std::array<bool, kMostSparse> row_known{}, column_known{};
    for (int v = std::max(0, -top); v < std::min(side_, depth_.rows - top); ++v) {
        const float* const row = depth_.ptr<float>(top + v);
        for (int u = std::max(0, -left); u < std::min(side_, depth_.cols - left); ++u) {
            if (!(row[left + u] > 0)) continue;
            roevo::at(row_known, v) = roevo::at(column_known, u) = true;
        }
    }
    rows = Offsets::known(row_known, side_);
    columns = Offsets::known(column_known, side_);
}

/// Across a border, of a large square only some pixels, or where few are known.
kernels::DepthSquare ForegroundDepth::copy(int left, int top, Copy& to) const {
    Offsets rows = Offsets::spread(side_), columns = rows;
    if (sparse_) lookForKnown(left, top, rows, columns);
    for (int c = 0; c < columns.count; ++c)
        roevo::at(to.columns, c) = static_cast<float>(roevo::at(columns.from_first, c));
    for (int r = 0; r < rows.count; ++r) {
        const int v = roevo::at(rows.from_first, r), row = top + v;
        roevo::at(to.rows, r) = static_cast<float>(v);
        for (int c = 0; c < columns.count; ++c) {
            const int column = left + roevo::at(columns.from_first, c);
            if (row >= 0 && row < depth_.rows && column >= 0 && column < depth_.cols)
                roevo::at(to.depths, r * kMost + c) = depth_.at<float>(row, column);
        }
    }
    return {to.depths.data(), kMost, std::max(rows.count, columns.count), to.columns.data(), to.rows.data()};
}

float ForegroundDepth::at(float u, float v) const {
    if (depth_.empty()) return 0;
    const int left = beginOf(u, side_), top = beginOf(v, side_);
    const bool is_inside = left >= 0 && top >= 0 && left + kMost <= depth_.cols && top + side_ <= depth_.rows;
    kernels::DepthPatch patch;
    const auto look = [&](const kernels::DepthSquare& square) {
        kernels::best().depthPatch(square, limits_, u - static_cast<float>(left), v - static_cast<float>(top),
                                   patch);
    };
    if (!sparse_ && side_ <= kMost && is_inside) {
        look({depth_.ptr<float>(top) + left, static_cast<std::ptrdiff_t>(depth_.step1()), side_,
              kSteps.data(), kSteps.data()});
    } else {
        Copy copied;
        look(copy(left, top, copied));
    }
    return patch.count > 0 ? depthAtEdge(patch, limits_) : 0;
}

}  // namespace roevo
