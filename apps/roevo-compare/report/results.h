#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo-compare/report/comparison.h"

namespace roevo {

/// Below this share of the frames a run ranks behind all that tracked more: its errors are of other,
/// usually easier frames.
constexpr double kCompleteShare = 0.9;

/// A sequence with the errors of its runs, index by index.
struct SequenceResults {
    const SequenceComparison* sequence = nullptr;
    std::vector<EvaluatedRun> evaluated;
};

std::vector<SequenceResults> evaluateAll(const std::vector<SequenceComparison>& sequences);

/// Share (0 to 1) of all frames that the method tracked: refused ones lower it; nothing when it was not run
/// or had no frame.
std::optional<double> trackedShare(const MethodRun& run);

/// Enough frames tracked to be compared with the others.
bool isComplete(const MethodRun& run);

/// Name of a run's method in tables.
const std::string& labelOf(const MethodRun& run);

/// A method as a row of the tables over all sequences.
struct TableMethod {
    std::string name, label, note;
};

/// Every method that has a run somewhere, in the order in which they come first.
std::vector<TableMethod> tableMethods(const std::vector<SequenceResults>& results);

/// Names of the stages of all runs, in the order in which they come first.
std::vector<std::string> stageNames(const std::vector<SequenceResults>& results);

/// Index of the method's run in the sequence, if it has one.
std::optional<std::size_t> findRun(const SequenceComparison& sequence, const std::string& method);

/// No pose with a number that is none.
bool allFinite(const std::vector<StampedPose>& trajectory);

/// Why a run has no errors, in words: skipped, failed, no ground truth, …; empty when it has.
std::string whyNoErrors(const SequenceComparison& sequence, const MethodRun& run,
                        const EvaluatedRun& evaluated);

}  // namespace roevo
