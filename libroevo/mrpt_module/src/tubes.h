#pragma once
#include <mrpt/img/TColor.h>

#include <Eigen/Core>
#include <vector>

#include "roevo_mrpt/scene_objects.h"

namespace roevo {

/// Appends a prism around each segment of a polyline.
void appendTube(compat::scene::CSetOfTriangles& out, const std::vector<Eigen::Vector3f>& polyline,
                float radius, const mrpt::img::TColor& colour);

}  // namespace roevo
