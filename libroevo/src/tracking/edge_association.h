#pragma once
#include <cstdint>
#include <vector>

#include "edges/canny.h"
#include "edges/edge_grid.h"
#include "edges/organized_edges.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"
#include "roevo/types.h"
#include "tracking/points3.h"

namespace roevo {

/// Pairs of associated points, and how much of the reference was found again.
struct EdgeMatches {
    std::vector<std::int32_t> reference, current;  ///< point indices of the pairs, in the reference's order
    std::vector<std::int32_t> visible;  ///< of each reference edge: looked-up points inside the image
    int looked_up_points = 0;           ///< of the reference
    int visible_points = 0;             ///< of them, those inside the image
    int matched_extent = 0;             ///< of them, those of matched edges

    std::size_t size() const { return reference.size(); }
    /// Share of the reference that is inside the image.
    double visibleShare() const { return share(visible_points, looked_up_points); }
    /// Share of the reference that is inside the image and on edges that are associated.
    double shownShare() const { return share(matched_extent, looked_up_points); }
    /// Share of the reference's edges that are associated, each edge counting by its visible length.
    double matchedRatio() const { return share(matched_extent, visible_points); }

  private:
    static double share(int some, int all) { return all > 0 ? static_cast<double>(some) / all : 0; }
};

/// Edge-wise association (Sec. V-C): nearest point within a radius whose normal agrees with the reprojected
/// edge's normal, then a vote of the points of an edge on pairs of edges; one edge may be associated with
/// several fragments.
class EdgeAssociator {
  public:
    /// @param camera  ideal
    /// @param span    points before and after that the tangent of a reprojected point is taken between
    EdgeAssociator(const PinholeCamera& camera, const FineOptions& options, int span)
        : max_u_(static_cast<float>(camera.width) - 1 - EdgeMask::kBorder),
          max_v_(static_cast<float>(camera.height) - 1 - EdgeMask::kBorder),
          span_(static_cast<std::size_t>(span)),
          options_(options) {}

    /// Of a reference at most so many points are looked up from now on; fine.max_points until then.
    void limit(int max_points) { options_.max_points = max_points; }
    /// One point of so many was looked up the last time.
    std::size_t stride() const { return stride_; }

    /// @param reference  reference edges (spans and normals)
    /// @param projected  their points at T_current_reference; outside the image where not visible
    /// @param grid       of the current edges
    /// @param radius     px
    void associate(const OrganizedEdges& reference, const ProjectedPoints3& projected,
                   const Pose& T_current_reference, const OrganizedEdges& current, const EdgeGrid& grid,
                   double radius, EdgeMatches& out);

  private:
    void vote(const OrganizedEdges& reference, const OrganizedEdges& current, EdgeMatches& matches);

    float max_u_, max_v_;  ///< px, of what is inside the image
    std::size_t span_;
    FineOptions options_;
    EdgeQueries queries_;
    std::vector<float> side_x_, side_y_;  ///< that their normals are on
    std::vector<std::int32_t> votes_, touched_;
    std::size_t stride_ = 1;  ///< every n-th point of a reference edge is looked up
};

/// Of edges with every n-th point, fewer must agree on a pair of edges.
FineOptions forThinned(FineOptions options);

}  // namespace roevo
