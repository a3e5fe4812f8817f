#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/plots.h"
#include "roevo-compare/report/tables.h"

namespace roevo {

/// A row for each method over all recordings: how many runs, failures, and quantiles of the errors, frames
/// tracked, times, memory.
Table distributionTable(const std::vector<SequenceResults>& results, const std::vector<TableMethod>& methods);

/// A box for each method (quartiles, whiskers to 5 and 95 %, a point for each recording beyond). @throws as
/// drawFigure()
Figure boxFigure(const Metric& metric, const std::vector<SequenceResults>& results, const Legend& legend);

/// Share of the recordings whose error is at most so much; what failed never is. @throws as drawFigure()
Figure cumulativeFigure(const Metric& metric, const std::vector<SequenceResults>& results,
                        const Legend& legend);

/// Why there is no error, how often, and an example: a row for each method and reason, numbers in reasons
/// left out.
Table reasonTable(const std::vector<SequenceResults>& results, std::size_t most);

/// The method that recordings are ordered by: the fullest of ROEVO's modes, else the first.
const TableMethod& leadingMethod(const std::vector<TableMethod>& methods);

/// Indices of the recordings with the largest ATE of the leading method, the worst first.
std::vector<std::size_t> worstRecordings(const std::vector<SequenceResults>& results, std::size_t count);

}  // namespace roevo
