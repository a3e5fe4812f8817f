#pragma once
#include <string>
#include <vector>

#include "report/comparison.h"

namespace roevo {

/// What a reader must know of how the runs came about, a sentence each: a machine that was busy, runs that
/// were not bound to a core.
std::vector<std::string> comparisonNotes(const std::vector<SequenceComparison>& sequences);

}  // namespace roevo
