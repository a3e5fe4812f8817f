#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/results.h"

namespace roevo {

/// What a reader must know before the figures, a sentence each, and each once: sequences that failed, ground
/// truth that is missing, a scale that cannot be right, damage, methods that were not given the same frames,
/// parts of recordings. Normally few or none.
std::vector<std::string> remarks(const std::vector<SequenceResults>& results);

/// What is odd about one sequence although it was run, without its name: its methods were not given the same
/// frames, damage, a scale that cannot be right.
std::vector<std::string> odditiesOf(const SequenceResults& results);

/// What is odd about one run: its own warnings and that on the scale.
std::vector<std::string> warningsOf(const MethodRun& run, const EvaluatedRun& evaluated);

}  // namespace roevo
