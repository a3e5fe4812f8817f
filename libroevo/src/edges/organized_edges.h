#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "indexing.h"

namespace roevo {

/// Organized edges of one image: ordered chains of sub-pixel points, stored as structure of arrays with edges
/// as spans over them. All arrays of points have size() entries; points of an edge are consecutive and in
/// order.
struct OrganizedEdges {
    std::vector<float> x, y;                    ///< sub-pixel position, px
    std::vector<float> gradient_x, gradient_y;  ///< unit image gradient at the edge pixel
    std::vector<float> normal_x, normal_y;      ///< unit edge normal on the gradient's side, Eqs. (4)-(6)
    std::vector<float> strength;                ///< gradient magnitude, grey levels per pixel
    std::vector<std::int32_t> edge_of;          ///< index of the edge that the point belongs to
    std::vector<std::int32_t> begin{0};         ///< first point of each edge, plus one past the end

    std::size_t size() const { return x.size(); }
    int numEdges() const { return begin.empty() ? 0 : static_cast<int>(begin.size()) - 1; }
    template <class Index>
    IndexRange pointsOf(Index edge) const {
        return rangeOf(begin, edge);
    }
    /// Room for this many points, which are to be set; numberPoints() sets their edges.
    void resize(std::size_t count);
    /// Adds a point to the edge being built; finishEdge() closes it.
    void addPoint(float px, float py, float gx, float gy, float magnitude);
    void finishEdge();
    /// Fills edge_of, as begin has it.
    void numberPoints();
    /// Adds an edge of points of another image: number `first` and so many further on.
    void addEdge(const OrganizedEdges& from, std::size_t first, const std::vector<std::size_t>& further);
};

/// The n with which every n-th of `count` points makes no more than `most`.
inline std::size_t strideFor(std::size_t count, int most) {
    const auto limit = static_cast<std::size_t>(std::max(1, most));
    return std::max<std::size_t>(1, (count + limit - 1) / limit);
}

/// Fills normal_x, normal_y (Eqs. (4)-(6)): orthogonal to the chord between the points `span` places before
/// and after (clamped to the edge's ends), on the side of the image gradient.
void computeNormals(OrganizedEdges& edges, int span);

}  // namespace roevo
