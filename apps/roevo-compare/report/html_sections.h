#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/protocol.h"

namespace roevo {

/// All up to and with <body>.
std::string pageHead(const std::string& title = kReportTitle);

/// A sentence that must not be missed.
std::string remark(const std::string& text);

std::string methodList(const Legend& legend);
std::string protocolSection(const Conditions& conditions);
std::string repeating(const ComparisonInfo& info);

/// What became better or worse since an earlier comparison; nothing without one.
std::string changesSection(const std::vector<SequenceResults>& results,
                           const std::vector<SequenceResults>& baseline);

/// The report of more than kManySequences recordings: distributions, failures, the worst ones.
/// @throws Interrupted after a signal
std::string htmlReportOfMany(const std::vector<SequenceResults>& results, const Legend& legend,
                             const ComparisonInfo& info, const std::string& folder, PageFiles& files,
                             const std::vector<SequenceResults>& baseline);

}  // namespace roevo
