#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

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
    std::vector<std::int32_t>
        begin;  ///< first point of each edge, plus one past the end: numEdges() + 1 entries

    std::size_t size() const { return x.size(); }
    int numEdges() const { return begin.empty() ? 0 : static_cast<int>(begin.size()) - 1; }
    void clear();
    /// Adds a point to the edge being built; finishEdge() closes it.
    void addPoint(float px, float py, float gx, float gy, float magnitude);
    void finishEdge();
};

/// Fills normal_x, normal_y (Eqs. (4)-(6)): orthogonal to the chord between the points `span` places before
/// and after (clamped to the edge's ends), on the side of the image gradient.
void computeNormals(OrganizedEdges& edges, int span);

}  // namespace roevo
