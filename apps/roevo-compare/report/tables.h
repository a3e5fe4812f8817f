#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/results.h"

namespace roevo {

/// table.csv: one row per sequence and method with every figure, SI units and milliseconds, named in the
/// head. What was not measured is empty, and a reason column says why.
std::string csvTable(const std::vector<SequenceResults>& results);

/// table.md: a table per figure, methods by sequences, the best bold, dashes with a footnote that says why.
std::string markdownTables(const std::vector<SequenceResults>& results, const ComparisonInfo& info);

/// The evaluation protocol, a sentence each, for every table that is printed.
const std::vector<std::string>& protocolLines();

}  // namespace roevo
