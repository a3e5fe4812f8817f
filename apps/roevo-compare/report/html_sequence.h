#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/html_parts.h"

namespace roevo {

/// Table of all figures of a sequence, each method linked with the folder of its run.
std::string allFigures(const SequenceResults& results, const std::string& id, const std::string& folder);

/// Trajectories from two sides, with their legend. @param files  see setFigure()
/// @throws NoGnuplot; Interrupted
std::string trajectoryBlock(const SequenceResults& results, const Legend& legend, const std::string& title,
                            PageFiles* files = nullptr);

/// Position errors over time, in all and by axis, and their cumulative curve, angular errors over time,
/// relative errors by path length; empty without any. @param alignment  in words. @param files  see
/// setFigure()
/// @throws NoGnuplot; Interrupted
std::string errorBlocks(const SequenceResults& results, const Legend& legend, const std::string& alignment,
                        PageFiles* files = nullptr);

/// Writes the sections of the sequences of one report: facts, figures, trajectories, errors, times, maps.
class SequenceWriter {
  public:
    /// @param folder      of the report
    /// @param with_table  of all figures; not when the summary shows it already
    /// @param files       takes plots and 3-D views
    SequenceWriter(const Legend& legend, std::string folder, bool with_table, PageFiles& files);

    /// @throws Interrupted after a signal
    std::string write(const SequenceResults& results, std::size_t number);

    /// Why there are no plots at all, e.g. that gnuplot is missing; empty when there are.
    const std::string& plotFault() const { return plot_fault_; }

  private:
    std::string plots(const SequenceResults& results);
    std::string maps(const SequenceResults& results) const;
    std::string view(const SequenceResults& results);

    const Legend& legend_;
    std::string folder_;
    bool with_table_;
    PageFiles& files_;
    std::vector<std::string> stages_;  // in the order of their colours
    std::string plot_fault_;
};

}  // namespace roevo
