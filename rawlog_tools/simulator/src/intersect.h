#pragma once
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// Nearest crossing of a ray, given in the primitive's unit coordinates, with its surface.
struct UnitHit {
    double t = 0;            ///< ray parameter, the same as in the world because the map is affine
    Eigen::Vector3d normal;  ///< in unit coordinates, not normalised
};

/// The ray o + t d with t in (t_min, t_max) against the unit shape. Quads and open sides are seen from both
/// faces.
bool intersectUnit(Shape shape, double taper, const Eigen::Vector3d& o, const Eigen::Vector3d& d,
                   double t_min, double t_max, UnitHit& hit);

}  // namespace roevo::simulator
