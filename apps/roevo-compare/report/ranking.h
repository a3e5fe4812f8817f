#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "roevo-compare/report/metrics.h"

namespace roevo {

/// Ranks (1 is best) of a sequence's runs by an error. Equal errors share the better rank and the next one is
/// left out. Runs that tracked too few frames rank behind all others; those without the error have no rank.
/// @param takes_part  one flag per run; the others have no rank and take no place
std::vector<std::optional<int>> rankRuns(const Metric& metric, const SequenceResults& results,
                                         const std::vector<bool>& takes_part);

/// A row of the table over all sequences.
struct RankRow {
    TableMethod method;
    std::array<int, 3> top{};  ///< sequences in which it is among the first 1, 2, 3
    int sequences = 0;         ///< that were ranked and that it was run on
    int failures = 0;          ///< of these: without an error
    double mean_rank = 0;      ///< a failure counts as the rank behind the last; 0 without sequences
};

/// The paper's rank table ("Quantitative Sequence Summary") by an error.
/// @param methods  names of those that take part, and in which order
std::vector<RankRow> rankTable(const Metric& metric, const std::vector<SequenceResults>& results,
                               const std::vector<TableMethod>& methods);

/// The paper ranks one ROEVO against the others, so that its modes do not take places from each other: the
/// last of ROEVO's modes in the table (the fullest one) and all foreign methods. All methods when there are
/// not several such modes.
std::vector<TableMethod> oneRoevo(const std::vector<TableMethod>& methods);

/// Of ROEVO's modes: 1 for the least, more for the fuller ones. 0 for other methods and unknown modes.
int fullnessOf(const std::string& method);

/// Whether a method is one of ROEVO's own modes.
bool isOurs(const std::string& method);

}  // namespace roevo
