#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "edges/organized_edges.h"

namespace roevo {

/// The pixel that a coordinate lies in.
inline int nearestPixel(float coordinate) {
    const float shifted = coordinate + 0.5F;
    const int towards_zero = static_cast<int>(shifted);
    return towards_zero - (shifted < static_cast<float>(towards_zero) ? 1 : 0);
}

/// Finds points of organized edges by where they are. Building it is linear; a radius search looks at one
/// word of occupancy bits per row and then only at the points in it, which are next to each other in memory.
class EdgeGrid {
  public:
    /// What a search asks of a point: one line of the cache.
    struct Point {
        float x, y, normal_x, normal_y;
        std::int32_t index;
    };

    void build(const OrganizedEdges& edges, int width, int height);

    /// Nearest point to (u, v) within `radius` (at most kMaxRadius) pixels that `accept(point)` agrees to,
    /// or -1. (u, v) may lie outside the image. Of points in one pixel only the last is found.
    /// @param guess  a point that may well be it, so that less is searched; -1 for none
    template <class Accept>
    int nearest(float u, float v, float radius, Accept&& accept, int guess = -1) const;

    static constexpr int kMaxRadius = 30;  ///< px

  private:
    static constexpr int kPadding = 64;  ///< px of empty occupancy left and right of a row
    Point pointAt(std::size_t index) const {
        const OrganizedEdges& edges = *edges_;
        return {edges.x[index], edges.y[index], edges.normal_x[index], edges.normal_y[index],
                static_cast<std::int32_t>(index)};
    }
    std::size_t bitIndex(int x, int y) const {
        return static_cast<std::size_t>(y) * row_bits_ + static_cast<std::size_t>(x + kPadding);
    }
    /// `count` (< 64) occupancy bits from this one on, the first in the lowest bit.
    std::uint64_t occupancy(std::size_t first, int count) const {
        const std::size_t word = first / 64, shift = first % 64;
        const std::uint64_t low = bits_[word] >> shift, high = bits_[word + 1] << 1 << (63 - shift);
        return (low | high) & ((std::uint64_t{1} << count) - 1);
    }
    /// How many points are in pixels before this one.
    std::size_t rank(std::size_t bit) const {
        const std::uint64_t before = bits_[bit / 64] & ((std::uint64_t{1} << (bit % 64)) - 1);
        return static_cast<std::size_t>(before_[bit / 64] + __builtin_popcountll(before));
    }

    int width_ = 0, height_ = 0;
    std::size_t row_bits_ = 0;
    std::vector<std::uint64_t> bits_;   ///< of each pixel, whether there is a point
    std::vector<std::int32_t> before_;  ///< of each word of them, how many points are in those before it
    std::vector<Point> points_;         ///< by pixel, row after row
    const OrganizedEdges* edges_ = nullptr;
};

template <class Accept>
int EdgeGrid::nearest(float u, float v, float radius, Accept&& accept, int guess) const {
    constexpr float kFar = kMaxRadius + 1;  // from here on nothing of the image is in reach
    if (!(u > -kFar && v > -kFar && u < static_cast<float>(width_) + kFar &&
          v < static_cast<float>(height_) + kFar)) {
        return -1;
    }
    const int cu = nearestPixel(u), cv = nearestPixel(v);
    const float within = std::min(radius, static_cast<float>(kMaxRadius));
    int best = -1;
    float best_squared = within * within;
    const auto consider = [&](const Point& point) {
        const float dx = point.x - u, dv = point.y - v;
        const float squared = dx * dx + dv * dv;
        if (squared >= best_squared || !accept(point)) return;
        best = point.index;
        best_squared = squared;
    };
    if (guess >= 0) consider(pointAt(static_cast<std::size_t>(guess)));
    for (int away = 0;; ++away) {  // rows 0, -1, +1, -2, +2 ...
        // Points are within half a pixel of their cell's centre, the query within half a pixel of its own
        const auto gap = static_cast<float>(std::max(0, away - 1));
        const float left = best_squared - gap * gap;
        if (left <= 0) break;
        const int reach = static_cast<int>(std::sqrt(left)) + 1;
        const auto look = [&](int y) {
            if (y < 0 || y >= height_) return;
            const std::size_t first = bitIndex(cu - reach, y);
            std::uint64_t row = occupancy(first, 2 * reach + 1);
            if (row == 0) return;
            for (std::size_t i = rank(first); row != 0; row &= row - 1) consider(points_[i++]);
        };
        look(cv - away);
        if (away > 0) look(cv + away);
    }
    return best;
}

}  // namespace roevo
