#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "report/comparison.h"

namespace roevo {

/// A row is what one method made of one recording, with all that tables need: facts of the recording, figures
/// of the run, errors, or the reason why there are none. It is kept as run.json in the folder of the run,
/// with trajectory.txt and groundtruth.txt (TUM), frames.csv
/// (timestamp,tracked,reason,ms_decode,ms_<stage>…,ms_total) and, for methods with a map, map.3Dscene beside
/// it.

/// Evaluates the run and writes its row, run.json last: a folder with run.json is whole.
/// @param sequence  with this one run. @throws std::runtime_error
void writeRow(const std::string& folder, const SequenceComparison& sequence);

/// The row of a folder as a sequence with one run, its trajectory and ground truth read.
/// @throws std::runtime_error in one line when it is not there or not whole
SequenceComparison readRow(const std::string& folder);

/// Reads trajectories and ground truth of all runs from their folders. A run whose files are not whole is a
/// failure then; its map may be missing.
void loadTrajectories(SequenceComparison& sequence);

/// Rows put together by recording.
struct Rows {
    std::vector<SequenceComparison> sequences;  ///< by name; their runs in the order of knownMethods()
    std::vector<std::string> notes;             ///< rows that could not be read, a line each
};

/// Without trajectories and ground truth: their errors are those that the rows state.
/// @param paths  folders, below which every run.json is a row, and files, which may have several rows one
/// after the other
/// @throws std::runtime_error when there is no row, a path cannot be read, or two rows are of the same run
Rows readRows(const std::vector<std::string>& paths);

}  // namespace roevo
