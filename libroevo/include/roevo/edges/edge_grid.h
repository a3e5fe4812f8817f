#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "roevo/edges/organized_edges.h"

namespace roevo {

/// Pixel-index grid over the points of organized edges: which point, if any, lies in a pixel. Building it is
/// linear; a radius search reads pixels in order of distance, so that a query near its answer touches a
/// handful of them.
class EdgeGrid {
  public:
    void build(const OrganizedEdges& edges, int width, int height);

    /// Nearest point to (u, v) within `radius` pixels that `accept(index)` agrees to, or -1.
    template <class Accept>
    int nearest(float u, float v, float radius, Accept&& accept) const;

    static constexpr int kMaxRadius = 15;  ///< px

  private:
    struct Offset {
        std::int16_t dx, dy;
        float distance;
    };
    static const std::vector<Offset>& spiral();

    int width_ = 0, height_ = 0;
    std::vector<std::int32_t> cell_;    ///< point index + 1, 0 when empty
    std::vector<std::int32_t> filled_;  ///< cells to clear before the next build
    const OrganizedEdges* edges_ = nullptr;
};

template <class Accept>
int EdgeGrid::nearest(float u, float v, float radius, Accept&& accept) const {
    const int cu = static_cast<int>(std::lround(u)), cv = static_cast<int>(std::lround(v));
    int best = -1;
    float best_squared = radius * radius;
    float reach = radius;
    for (const Offset& offset : spiral()) {
        // A point in a cell can be nearer than the cell's centre by half a diagonal, and the query sits as
        // much off its own.
        if (offset.distance - 1.5F > reach) break;
        const int x = cu + offset.dx, y = cv + offset.dy;
        if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
        const std::int32_t index = cell_[static_cast<std::size_t>(y * width_ + x)] - 1;
        if (index < 0) continue;
        const auto i = static_cast<std::size_t>(index);
        const float dx = edges_->x[i] - u, dy = edges_->y[i] - v;
        const float squared = dx * dx + dy * dy;
        if (squared >= best_squared || !accept(i)) continue;
        best = index;
        best_squared = squared;
        reach = std::sqrt(squared);
    }
    return best;
}

}  // namespace roevo
