#pragma once
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// Rigid motion T (no scale) that minimises sum |target_i - T source_i|^2 (Umeyama, PAMI 1991).
/// @param source, target  points in metres, equally many, at least 3
/// @throws std::invalid_argument when they are fewer or not equally many
Pose alignRigidly(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target);

}  // namespace roevo
