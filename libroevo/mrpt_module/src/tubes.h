#pragma once
#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <Eigen/Core>
#include <vector>

namespace roevo {

/// Appends a prism around each segment of a polyline.
void appendTube(mrpt::opengl::CSetOfTriangles& out, const std::vector<Eigen::Vector3f>& polyline,
                float radius, const mrpt::img::TColor& colour);

}  // namespace roevo
