#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "method.h"
#include "roevo/options.h"
#include "run_queue.h"
#include "sequences.h"

namespace roevo {

/// What to compare on what, from the command line.
struct CompareSettings {
    std::vector<SequenceInput> sequences;
    std::vector<std::string> missing;  ///< sequences of a list that are not on this disk, a line each
    std::vector<MethodInfo> methods;
    std::string output;
    OdometryOptions options;
    QueueOptions queue;
    bool resume = false;  ///< take finished runs with the same settings again
    bool quiet = false;
    std::string command;  ///< the whole command line, for the report
};

/// What there is to show once the runs are done.
struct CompareResult {
    std::vector<SequenceComparison> sequences;
    ComparisonInfo info;
    bool interrupted = false;
    std::size_t runs = 0, left = 0;  ///< that are in the report, and that are still to be made
};

/// Makes the runs and writes the report: <output>/runs/<sequence>/<method>/, table.csv, table.md and
/// report.html. After an interrupt (see InterruptGuard) the report has what is finished by then; a second
/// one, or one while the report is being written, ends that.
/// @throws UsageError; std::runtime_error in one line, also when not one sequence can be used (then nothing
/// is written); Interrupted when no run was finished, or there is no report
CompareResult compare(const CompareSettings& settings);

}  // namespace roevo
