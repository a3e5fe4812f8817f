#pragma once
#include <mrpt/maps/CColouredPointsMap.h>

#include "roevo/edge_map.h"

namespace roevo {

inline void append(mrpt::maps::CColouredPointsMap& out, const Eigen::Vector3f& p, const Rgb& c) {
    out.insertPointRGB(p.x(), p.y(), p.z(), c[0] / 255.f, c[1] / 255.f, c[2] / 255.f);
}

inline void appendEdge(mrpt::maps::CColouredPointsMap& out, const MapEdge& edge, const Pose& T_out_world) {
    const Eigen::Isometry3f T = T_out_world.cast<float>();
    for (std::size_t i = 0; i < edge.points.size(); i++) append(out, T * edge.points[i], edge.colours.at(i));
}

}  // namespace roevo
