#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// An organized edge of the map: points in order along the edge, world frame, metres.
struct MapEdge {
    std::vector<Eigen::Vector3f> points;
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< RGB of the image, one per point
    int keyframe_id = 0;                               ///< keyframe that saw it
    float confidence = 1;                              ///< 0..1
};

using EdgeMap = std::vector<MapEdge>;

}  // namespace roevo
