#pragma once
#include <string>
#include <vector>

#include "method.h"
#include "report/comparison.h"
#include "roevo/options.h"
#include "sequences.h"

namespace roevo {

/// What to compare on what, from the command line.
struct CompareSettings {
    std::vector<SequenceInput> sequences;
    std::vector<MethodInfo> methods;  ///< named with their variant
    std::string output;
    OdometryOptions options;
    double timeout_s = 0;  ///< of a run
    double memory_mb = 0;  ///< of a run; 0: no limit
    std::string key;       ///< of all runs, see MethodRun
    bool quiet = false;
    std::string command;  ///< the whole command line, for the report
};

/// Makes the runs, one after the other, and writes the report: <output>/runs/<sequence>/<method>/, table.csv,
/// table.md and report.html.
/// @return all that is in the report. @throws UsageError; std::runtime_error in one line, also when not one
/// sequence can be used (then nothing is written); Interrupted after a signal: runs that have ended are kept
ComparisonReport compare(const CompareSettings& settings);

/// Makes the runs and nothing but their rows, a recording that cannot be used among them. Several programs
/// may do so in one folder. @throws as compare()
void makeRows(const CompareSettings& settings);

/// The report of rows that are there. @param baseline  rows to compare with; may be empty
/// @throws as readRows() and writeComparison()
ComparisonReport reportRows(const std::vector<std::string>& rows, const std::vector<std::string>& baseline,
                            const std::string& output, const std::string& command);

}  // namespace roevo
