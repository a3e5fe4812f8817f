#pragma once
#include <map>
#include <vector>

#include "mapping/edge_fusion.h"
#include "mapping/map_keyframe.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "roevo/options.h"

namespace roevo {

/// What most of the keyframes' edges that each fused edge is made of were thought to be.
void takeKeptVerdicts(const std::vector<WindowKeyframe>& window, FusedEdges& edges);

/// All keyframes' edges fused at the present poses (Eqs. (14)-(16)).
/// @param keyframes  by their ids, with their points
/// @param clusters   of each keyframe's edges, in the same order
EdgeMap fuseEdges(const std::map<int, MapKeyframe>& keyframes, const std::vector<std::vector<int>>& clusters,
                  const PinholeCamera& camera, const OdometryOptions& options);

/// The edges of each keyframe as it saw them; keyframes and clusters as above.
EdgeMap edgesAsSeen(const std::map<int, MapKeyframe>& keyframes,
                    const std::vector<std::vector<int>>& clusters, const SensorOptions& sensor);

}  // namespace roevo
