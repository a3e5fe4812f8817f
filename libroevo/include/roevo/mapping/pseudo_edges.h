#pragma once
#include <utility>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/mapping/edge_fusion.h"
#include "roevo/options.h"

namespace roevo {

/// Recognises pseudo-edges: cast shadows that move, reflections, occlusion borders.
class PseudoEdgeJudge {
  public:
    PseudoEdgeJudge(const MappingOptions& mapping, const SensorOptions& sensor, const PinholeCamera& camera)
        : options_(mapping), sensor_(sensor), camera_(camera) {}

    /// Gives every edge its verdict: by the spread of its observations (instead of Eq. (16)'s largest
    /// eigenvalue, which the depth noise of the sensor dominates, across the edge in the images), and by
    /// keyframes and frames that look at its place and do not see it.
    /// @param scale  robust spread of point-to-tangent residuals, px
    void judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges, double scale) const;

  private:
    double spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges, std::size_t p) const;
    /// Keyframes that look at the place of an edge, and those of them that see it.
    std::pair<int, int> countLooks(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                   std::size_t edge) const;
    double foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                      std::size_t edge) const;

    MappingOptions options_;
    SensorOptions sensor_;
    PinholeCamera camera_;
};

}  // namespace roevo
