#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/results.h"

namespace roevo {

constexpr char kReportTitle[] = "Comparison of RGB-D odometries";

class PageFiles;

/// table.csv: one row per sequence and method with every figure, SI units and milliseconds, named in the
/// head. What was not measured is empty, and a reason column says why.
std::string csvTable(const std::vector<SequenceResults>& results);

/// table.md: a table per figure, methods by sequences, the best bold, dashes with a footnote that says why.
std::string markdownTables(const std::vector<SequenceResults>& results, const ComparisonInfo& info);

/// report.html, well-formed XML, with plots and pictures inside and nothing to be loaded.
/// @param files     plots as files and 3-D views, to lie beside it
/// @param folder    where it will lie: links to the runs are relative to it
/// @param baseline  an earlier comparison; may be empty
std::string htmlReport(const std::vector<SequenceResults>& results, const ComparisonInfo& info,
                       const std::string& folder, PageFiles& files,
                       const std::vector<SequenceResults>& baseline = {});

/// Where a report of many has the page of one of its recordings: in its folder `pages`.
std::string pageFile(const std::string& folder, const SequenceComparison& sequence);

/// Whether there is something for such a page.
bool hasTrajectories(const SequenceComparison& sequence);

}  // namespace roevo
