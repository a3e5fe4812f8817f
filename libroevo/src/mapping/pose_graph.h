#pragma once
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// What is known of one pose relative to another.
struct PoseConstraint {
    int from = 0, to = 0;
    Pose T_from_to = Pose::Identity();
    Matrix6d covariance = Matrix6d::Identity();  ///< position, then orientation, along the axes of `to`
};

/// Moves poses to where they fit all constraints best: a few steps of Gauss-Newton, sparse. Every constraint
/// must be tied to a fixed pose by others; poses without a constraint stay.
/// @param poses  T_world_camera of each
/// @param fixed  the one that stays, with all before it
/// @return false, with the poses as they were, where there is no solution
[[nodiscard]] bool optimisePoseGraph(std::vector<Pose>& poses, const std::vector<PoseConstraint>& constraints,
                                     int fixed);

/// How far poses are from what a constraint says, squared, in sigmas.
double contradiction(const std::vector<Pose>& poses, const PoseConstraint& constraint);

}  // namespace roevo
