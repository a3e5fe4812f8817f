#pragma once
#include <string>
#include <vector>

#include "tables.h"

namespace roevo {

/// A page that needs nothing but itself: the table of the estimates, trajectories from two
/// sides, errors over time and their cumulative curve.
/// @param alignment  in words
/// @throws NoGnuplot; Interrupted
std::string htmlPage(const std::string& reference_file, const std::vector<StampedPose>& reference,
                     const std::vector<JudgedEstimate>& estimates, const std::string& alignment,
                     double max_dt);

}  // namespace roevo
