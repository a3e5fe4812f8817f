#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "edges/organized_edges.h"
#include "kernels/kernels.h"

namespace roevo {

/// Points of edges that look for their like: where they are, px, and their unit normals.
struct EdgeQueries {
    std::vector<float> u, v, normal_x, normal_y;
};

/// Finds points of organized edges by where they are. They lie in cells, row after row, so that what a row of
/// cells holds between two columns is one stretch of memory. Building it is linear.
class EdgeGrid {
  public:
    void build(const OrganizedEdges& edges, int width, int height);

    /// Of each of the first `count` queries the nearest point within `radius` px whose normal is at most so
    /// far from its own, or -1. Queries may lie outside the image, up to 1e6 px.
    void nearest(const EdgeQueries& queries, std::size_t count, double radius, double min_cosine,
                 std::int32_t* found) const;

    /// Whether a point nearer than `radius` px to (u, v) is one that `accept(index)` agrees to.
    template <class Accept>
    bool any(float u, float v, float radius, Accept&& accept) const;

  private:
    int column(float x) const { return cellOf(x, 1.0F / kernels::kCellWidth, columns_); }
    int row(float y) const { return cellOf(y, 1.0F / kernels::kCellHeight, rows_); }
    static int cellOf(float at, float per_pixel, int count) {
        return std::clamp(static_cast<int>(at * per_pixel), 0, count - 1);
    }

    int columns_ = 0, rows_ = 0;
    std::vector<std::int32_t> first_;  ///< of each cell, its first point; and where the last one ends
    std::vector<std::int32_t> cell_;   ///< of each point of the edges
    std::vector<std::int32_t> index_;  ///< among the edges' points, of each one here; the next ones likewise
    std::vector<float> x_, y_, normal_x_, normal_y_;
};

template <class Accept>
bool EdgeGrid::any(float u, float v, float radius, Accept&& accept) const {
    const int left = column(u - radius), right = column(u + radius), bottom = row(v + radius);
    for (int y = row(v - radius); y <= bottom; ++y) {
        const auto first = static_cast<std::size_t>(at(first_, y * columns_ + left)),
                   end = static_cast<std::size_t>(at(first_, y * columns_ + right + 1));
        for (std::size_t k = first; k < end; ++k) {
            const float du = x_[k] - u, dv = y_[k] - v;
            if (du * du + dv * dv < radius * radius && accept(static_cast<std::size_t>(index_[k])))
                return true;
        }
    }
    return false;
}

}  // namespace roevo
