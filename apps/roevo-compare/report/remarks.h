#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/results.h"

namespace roevo {

/// What a reader must know before the figures, a sentence each, and each once: sequences that failed, ground
/// truth that is missing, a scale that cannot be right, damage, methods that were not given the same frames
/// or options, parts of recordings. Normally few or none.
std::vector<std::string> remarks(const std::vector<SequenceResults>& results);

/// What is odd about one sequence although it was run, without its name: its methods were not given the same
/// frames, damage, a scale that cannot be right.
std::vector<std::string> odditiesOf(const SequenceResults& results);

/// What is odd about one run of a sequence: its own warnings, that on the scale, and what sets it apart.
/// @param options  see optionsRemark()
std::vector<std::string> warningsOf(const MethodRun& run, const EvaluatedRun& evaluated,
                                    const SequenceComparison& sequence,
                                    const std::optional<std::string>& options);

/// That ROEVO was run with several configurations, variants apart, and by which options they differ.
std::optional<std::string> optionsRemark(const std::vector<SequenceResults>& results);

Conditions conditionsOf(const std::vector<SequenceResults>& results);

/// What of the recording all runs are of; empty: all of it, or not the same.
std::string commonPart(const SequenceComparison& sequence);

}  // namespace roevo
