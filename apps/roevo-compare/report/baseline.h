#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/tables.h"

namespace roevo {

/// One recording's error now and in an earlier comparison.
struct ErrorPair {
    std::string sequence;
    double before = 0, now = 0;  ///< ATE RMSE, cm
    double ratio() const { return now / before; }
};

/// What became of a method since an earlier comparison. What recordings differ by anyway is judged by
/// themselves: the spread of their ratios about the median ratio.
struct MethodChange {
    TableMethod method;
    std::vector<ErrorPair> pairs;  ///< recordings with an error both times, by ratio
    double median = 1;             ///< ratio of the errors, now by before
    double low = 1, high = 1;  ///< 95 % interval of the median (order statistics: no distribution assumed)
    std::vector<ErrorPair> better, worse;   ///< beyond noise: 3 robust sigmas from the median, and 5 %
    std::vector<std::string> lost, gained;  ///< recordings that have no error any more, or now
    /// "better", "worse", "no difference", or "too few to tell".
    const char* verdict() const;
};

/// Methods that both comparisons have.
std::vector<MethodChange> changesSince(const std::vector<SequenceResults>& before,
                                       const std::vector<SequenceResults>& now);

/// A row for each method: recordings, median ratio and its interval, how many became better or worse.
Table changeTable(const std::vector<MethodChange>& changes);

/// The same in a sentence for each method; one that there is none.
std::vector<std::string> changeSentences(const std::vector<MethodChange>& changes);

/// The recordings that became worse or better beyond noise, the largest changes first, so many of each.
Table changedRecordings(const MethodChange& change, std::size_t most);

}  // namespace roevo
