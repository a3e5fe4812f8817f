#pragma once
#include <string>
#include <vector>

#include "report/comparison.h"

namespace roevo {

/// The main figures of a comparison as lines for a terminal: for each sequence a row per method, with the
/// reason where there is no figure, the best marked by an asterisk.
std::string terminalTable(const std::vector<SequenceComparison>& sequences);

}  // namespace roevo
