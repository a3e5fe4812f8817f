#pragma once
#include <string>
#include <vector>

#include "compare.h"

namespace roevo {

/// What a reader must know of how a comparison came about, a sentence each: a machine that was busy, runs
/// that were not bound to a core or went on side by side, sequences that are not there, an interrupt.
std::vector<std::string> comparisonNotes(const CompareSettings& settings, const CompareResult& result);

}  // namespace roevo
