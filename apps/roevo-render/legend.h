#pragma once

#include <string>
#include <vector>

#include "background.h"
#include "roevo_mrpt/mrpt_compat.h"

namespace roevo {

/// A line of the legend: what is drawn in these colours.
struct LegendEntry {
    std::string text;
    std::vector<Colour> colours;  ///< side by side
};

/// What the visible objects of a scene are. Objects that roevo-odometry does not make have no entry.
/// Call after the scene's colours were prepared for the background.
std::vector<LegendEntry> legendOf(compat::Scene& scene, const Background& background, bool all_layers);

}  // namespace roevo
