#pragma once
#include <string>
#include <vector>

#include "sequences.h"

namespace roevo {

/// What a machine-readable list of sequences (datasets_readme/sequences.json) comes to on this disk.
struct BenchmarkList {
    std::vector<SequenceInput> sequences;  ///< those that are there, in the order of the list
    std::vector<std::string> missing;  ///< a line for each of the others: its name, and what was looked for
};

/// A sequence is there as the folder that the list names for it, below `data`, or as <name>.rawlog or
/// <folder>.rawlog. Its key `truncation` is null (the whole sequence counts), or has `frames`: a range
/// [begin, end) of frames that alone count, or several, each of which becomes a sequence of its own; null
/// where nobody knows which, and then its `note` goes along and the paper's figure does not.
/// @throws std::runtime_error in one line when the list cannot be read or lacks something (names the
/// sequence and the key), or `data` is no folder
BenchmarkList readBenchmarkList(const std::string& file, const std::string& data);

}  // namespace roevo
