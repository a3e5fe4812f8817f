#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/bundle_adjustment.h"
#include "tracking/edge_clusters.h"

namespace roevo {

/// What is not known of a window's newest keyframe once it is refined: position, then orientation, along its
/// camera's axes.
struct WindowPosterior {
    int oldest = 0, reused = 0;   ///< keyframes that are fixed: of the window, and the oldest one from before
    PoseUncertainty uncertainty;  ///< if they were where they are
    /// Its error per error of the oldest keyframe of the window, along that one's axes, if those from before
    /// have none.
    Matrix6d follows;
};

/// The sandwich estimator: what each edge pulls, through the inverse of the normal equations. Edges are what
/// errs independently, and so do the priors.
/// @param equations  with the priors, as they were solved
/// @param clusters  of each fused edge: how tracking numbers it (Keyframe::clusters)
/// @return none where the edges do not tell, or where no keyframe from before the window takes part
std::optional<WindowPosterior> posteriorOf(const std::vector<WindowKeyframe>& window,
                                           const WindowEquations& equations,
                                           const std::vector<std::int32_t>& clusters,
                                           const std::vector<RelativePrior>& priors);

}  // namespace roevo
