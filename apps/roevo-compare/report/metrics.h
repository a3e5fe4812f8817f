#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo-compare/report/results.h"

namespace roevo {

/// One figure of a run, as the tables show it.
struct Metric {
    std::string title;  ///< "ATE RMSE"
    std::string brief;  ///< the same as the head of a narrow column
    std::string unit;   ///< as shown, e.g. "cm"; `value` is in it
    int decimals = 0;
    bool is_error = false;  ///< needs ground truth, and is ranked
    bool is_share = false;  ///< of frames tracked: says what the errors are worth, and has no best
    std::optional<double> (*value)(const MethodRun& run, const EvaluatedRun& evaluated) = nullptr;
};

/// The figures that have a table of their own, errors first: ATE, RPE per second, RPE per frame, tracked
/// share, times, memory.
const std::vector<Metric>& shownMetrics();

/// The figure, or nothing where it was not measured or is not finite.
std::optional<double> metricOf(const Metric& metric, const SequenceResults& results, std::size_t run);

/// Which runs share the best figure at the shown digits: of those that tracked enough, or of all when none
/// did. None when fewer than two runs have one.
std::vector<bool> bestRuns(const Metric& metric, const SequenceResults& results);

}  // namespace roevo
