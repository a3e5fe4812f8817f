#pragma once
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "roevo-compare/method_run.h"
#include "roevo/types.h"

namespace roevo {

/// Errors of each run against the sequence's reference; absent with the reason in words.
struct EvaluatedRun {
    std::optional<Evaluation> evaluation;
    std::string fault;
    std::string scale_warning;  ///< see scaleContradiction(); empty unless most methods say so
};

/// One recording and what every method made of it.
struct SequenceComparison {
    std::string name;     ///< of the table's row, e.g. "fr1_xyz"
    std::string input;    ///< as given
    std::string failure;  ///< why nothing could be run on it (unreadable, …); empty otherwise
    /// What a reader must know of it, a line each: how images were paired, what was substituted or left out.
    std::vector<std::string> notes;
    std::string ground_truth;              ///< file or folder, empty when there is none
    std::vector<StampedPose> reference;    ///< the ground truth's poses; may be empty
    std::string ground_truth_fault;        ///< why there is none although one was named
    std::vector<MethodRun> runs;           ///< in the order of the tables
    std::vector<std::string> run_folders;  ///< where each is kept, for links and scenes
    std::vector<EvaluatedRun> errors;      ///< of each run, as its row states them; empty: to be computed
    std::optional<double> paper_ate_cm;    ///< the paper's ROEVO-TR+BA on the same frames, when it has it
};

/// What a reader must know to repeat it.
struct ComparisonInfo {
    std::string command;                                        ///< the exact command line
    std::string date;                                           ///< ISO, UTC
    std::string machine;                                        ///< processor, cores, memory, system
    std::vector<std::pair<std::string, std::string>> versions;  ///< roevo, mrpt, opencv, eigen, compiler, …
    /// What a reader must know of this comparison, a sentence each: a busy machine, rows that are damaged.
    std::vector<std::string> notes;
};

/// Computed from the trajectories, once, unless SequenceComparison::errors has them.
std::vector<EvaluatedRun> evaluateRuns(const SequenceComparison& sequence);

/// A comparison that has been written.
struct ComparisonReport {
    std::vector<SequenceComparison> sequences;
    ComparisonInfo info;
};

/// Up to so many recordings each has its own part in the report; more are shown by their distribution.
constexpr std::size_t kManySequences = 40;

/// Of more than these a page is written for the worst ones.
constexpr std::size_t kWorstSequences = 10;

/// Writes table.csv, table.md and report.html (all pictures inside, no network) into the folder, each whole
/// or not at all; of more than kManySequences also a page in pages/ for each whose trajectories are there.
/// What an earlier report has left in figures/, views/ and pages/ is removed (files to which its pages have
/// links, nothing else).
/// @param baseline  an earlier comparison to compare with; may be empty
/// @throws std::runtime_error in one line; Interrupted after a signal (needs an InterruptGuard), and then
/// nothing has been written
void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info, const std::vector<SequenceComparison>& baseline = {});

}  // namespace roevo
