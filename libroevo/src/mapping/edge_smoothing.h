#pragma once
#include <vector>

#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo {

/// Smooths the depth of an edge as its camera saw it: each point moves along its viewing ray to a line
/// through the depths of its neighbours. The image of the edge stays as it is. Where the line is farther off
/// than the sensor's noise explains, there is a bend or a step, and the point stays.
/// @param points  consecutive points of an edge, world, m
/// @param T_world_camera  the camera that saw them
void smoothDepthAlong(std::vector<Eigen::Vector3d>& points, const Pose& T_world_camera,
                      const SensorOptions& sensor);

}  // namespace roevo
