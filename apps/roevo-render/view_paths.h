#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// A trajectory with its name.
struct NamedPath {
    std::string name;
    std::vector<StampedPose> poses;
};

/// A trajectory as it is shown, in the world of the first one.
struct ViewPath {
    std::string name;
    std::vector<StampedPose> poses;
    std::vector<float>
        errors;  ///< m, one per pose, NaN where there is no truth; empty without a ground truth
    std::optional<double> ate;  ///< m, RMSE
};

/// Brings trajectories into the world of the first one. With a ground truth each is aligned with it as
/// roevo-eval does (SE(3), no scale); without one, those from `foreign` on are aligned with the first, those
/// before it are in its world already.
/// @param truth  may be empty; it comes last in what is returned, cut to the time of the first
/// @throws std::runtime_error with the name of a trajectory that has fewer than 3 poses in common
std::vector<ViewPath> alignPaths(const std::vector<NamedPath>& paths, std::size_t foreign,
                                 const NamedPath& truth);

}  // namespace roevo
