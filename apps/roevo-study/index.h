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
    std::string command;  ///< as typed
    std::vector<IndexEntry> entries;
};

/// The command as it can be typed again in a shell.
std::string commandLine(int argc, const char* const* argv);

/// Writes study.md: the command, the recordings, and each experiment with its tables and plots.
/// @throws std::runtime_error
void writeIndex(const std::string& folder, const std::vector<StudyInput>& inputs, const StudyIndex& index);

}  // namespace roevo
