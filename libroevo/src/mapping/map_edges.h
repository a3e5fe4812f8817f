#pragma once
#include <map>
#include <vector>

#include "mapping/edge_fusion.h"
#include "mapping/map_keyframe.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "roevo/options.h"

namespace roevo {

/// All that the map knows, to make edges from for those who look at it.
struct MapContents {
    const std::map<int, MapKeyframe>& keyframes;              ///< with their points
    std::vector<std::vector<int>> clusters;                   ///< of each keyframe's edges, in the same order
    const std::map<int, std::vector<EdgeVerdict>>& verdicts;  ///< of each keyframe's edges
};

/// What most of the keyframes' edges that each fused edge is made of were thought to be.
void takeKeptVerdicts(const std::map<int, std::vector<EdgeVerdict>>& verdicts,
                      const std::vector<WindowKeyframe>& window, FusedEdges& edges);

/// All keyframes' edges fused at the present poses (Eqs. (14)-(16)).
EdgeMap fuseEdges(const MapContents& map, const PinholeCamera& camera, const OdometryOptions& options);

/// The edges of each keyframe as it saw them.
EdgeMap edgesAsSeen(const MapContents& map, const SensorOptions& sensor);

}  // namespace roevo
