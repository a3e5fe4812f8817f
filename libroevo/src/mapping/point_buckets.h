#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "edges/organized_edges.h"

namespace roevo {

/// The points of an image in square cells: small enough for the first-level cache, and quick to build for a
/// few thousand points. For single questions; where all points of a frame are looked up, EdgeGrid is faster.
class PointBuckets {
  public:
    void build(const OrganizedEdges& edges, int width, int height) {
        edges_ = &edges;
        columns_ = width / kCell + 1;
        rows_ = height / kCell + 1;
        first_.assign(static_cast<std::size_t>(columns_ * rows_), -1);
        next_.resize(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            std::int32_t& first = first_[cellAt(column(edges.x[i]), row(edges.y[i]))];
            next_[i] = first;
            first = static_cast<std::int32_t>(i);
        }
    }

    /// Whether a point within `radius` px of (u, v) is one that `accept(index)` agrees to.
    template <class Accept>
    bool any(float u, float v, float radius, Accept&& accept) const {
        const int right = column(u + radius), bottom = row(v + radius);
        for (int y = row(v - radius); y <= bottom; ++y) {
            for (int x = column(u - radius); x <= right; ++x) {
                for (std::int32_t k = first_[cellAt(x, y)]; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
                    const auto i = static_cast<std::size_t>(k);
                    const float du = edges_->x[i] - u, dv = edges_->y[i] - v;
                    if (du * du + dv * dv <= radius * radius && accept(i)) return true;
                }
            }
        }
        return false;
    }

  private:
    static constexpr int kCell = 8;  ///< px
    int column(float x) const { return std::clamp(static_cast<int>(x) / kCell, 0, columns_ - 1); }
    int row(float y) const { return std::clamp(static_cast<int>(y) / kCell, 0, rows_ - 1); }
    std::size_t cellAt(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

    const OrganizedEdges* edges_ = nullptr;
    int columns_ = 0, rows_ = 0;
    std::vector<std::int32_t> first_, next_;
};

}  // namespace roevo
