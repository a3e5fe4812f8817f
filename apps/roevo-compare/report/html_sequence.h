#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/plots.h"

namespace roevo {

/// Table of all figures of a sequence, each method linked with the folder of its run.
std::string allFigures(const SequenceResults& results, const std::string& id, const std::string& folder);

/// Trajectories from above and from the side, with their legend. @throws NoGnuplot; Interrupted
std::string trajectoryBlock(const SequenceResults& results, const Legend& legend, const std::string& title);

/// Position errors over time, and their cumulative curve; empty without any. @param alignment  in words
/// @throws NoGnuplot; Interrupted
std::string errorBlocks(const SequenceResults& results, const Legend& legend, const std::string& alignment);

/// Writes the sections of the sequences of one report: facts, figures, trajectories, errors, times, maps.
class SequenceWriter {
  public:
    /// @param folder      of the report
    /// @param with_table  of all figures; not when the summary shows it already
    SequenceWriter(const Legend& legend, std::string folder, bool with_table);

    /// @throws Interrupted after a signal
    std::string write(const SequenceResults& results, std::size_t number);

    /// Why there are no plots at all, e.g. that gnuplot is missing; empty when there are.
    const std::string& plotFault() const { return plot_fault_; }

  private:
    std::string plots(const SequenceResults& results);
    std::string maps(const SequenceResults& results) const;

    const Legend& legend_;
    std::string folder_;
    bool with_table_;
    std::vector<std::string> stages_;  // in the order of their colours
    std::string plot_fault_;
};

}  // namespace roevo
