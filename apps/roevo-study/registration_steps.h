#pragma once
#include <cstddef>

#include "edges/organized_edges.h"
#include "roevo/options.h"
#include "tracking/keyframe.h"

namespace roevo {

/// Points of a keyframe that both registrations reproject and look up in every step.
inline std::size_t lookedUpPoints(const Keyframe& keyframe, const FineOptions& options) {
    const std::size_t all = keyframe.edges.size(), stride = strideFor(all, options.max_points);
    return (all + stride - 1 - stride / 2) / stride;  // from the one at stride / 2 on
}

/// With so many steps allowed a registration takes every one of them: the search radius narrows down to the
/// last.
inline constexpr int kFixedSteps = 5;

}  // namespace roevo
