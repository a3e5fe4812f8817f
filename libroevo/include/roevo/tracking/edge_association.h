#pragma once
#include <cstdint>
#include <vector>

#include "roevo/edges/edge_grid.h"
#include "roevo/edges/organized_edges.h"
#include "roevo/options.h"

namespace roevo {

/// Which point of the current image each reprojected point of a reference edge is associated with.
struct EdgeMatches {
    std::vector<std::int32_t> point;  ///< index into the current edges' points, -1 where none
    int num_points = 0;               ///< associated points
    int visible_edges = 0,
        matched_edges = 0;   ///< reference edges inside the image; those with an association
    int visible_points = 0;  ///< reference points inside the image

    double matchedRatio() const {
        return visible_points > 0 ? static_cast<double>(matched_extent) / visible_points : 0;
    }
    int matched_extent = 0;  ///< visible points of the matched edges
};

/// Edge-wise association (Sec. V-C): nearest point within a radius whose normal agrees with the reprojected
/// edge's normal, then a vote of the points of an edge on pairs of edges; one edge may be associated with
/// several fragments.
class EdgeAssociator {
  public:
    explicit EdgeAssociator(const FineOptions& options) : options_(options) {}

    /// @param reference   reference edges (spans and gradients)
    /// @param u, v        their reprojected points, px; outside the image where not visible
    /// @param gradient_u, gradient_v  their image gradients turned into the current image (unit, for the side
    /// of the normal)
    /// @param span        points before and after that the tangent of a reprojected point is taken between
    void associate(const OrganizedEdges& reference, const float* u, const float* v, const float* gradient_u,
                   const float* gradient_v, int span, const OrganizedEdges& current, const EdgeGrid& grid,
                   int width, int height, double radius, EdgeMatches& out);

  private:
    void vote(const OrganizedEdges& reference, const OrganizedEdges& current, EdgeMatches& matches);

    FineOptions options_;
    std::vector<std::int32_t> votes_, touched_, visible_;
    int stride_ = 1;  ///< every so manieth point of a reference edge is looked up
};

}  // namespace roevo
