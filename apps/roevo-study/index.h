#pragma once
#include <string>
#include <vector>

#include "study.h"

namespace roevo {

/// One experiment in the index.
struct IndexEntry {
    std::string title;
    StudyReport report;   ///< empty when it failed
    std::string failure;  ///< in words
};

struct StudyIndex {
    std::string command;            ///< as it can be typed again in a shell
    std::string time;               ///< of the start, ISO 8601, UTC
    std::vector<LeftOut> left_out;  ///< recordings that could not be opened
    std::vector<IndexEntry> entries;
};

/// "name: what is wrong" of the recordings that are damaged, as far as they have been read.
std::vector<std::string> damageLines(const std::vector<StudyInput>& inputs);

/// Writes study.md: the command, the machine and the versions, the protocol, the recordings, and each
/// experiment with its tables and plots.
/// @throws std::runtime_error
void writeIndex(const std::string& folder, const std::vector<StudyInput>& inputs, const StudyIndex& index);

}  // namespace roevo
