#pragma once
/// Which colour image goes with which depth image: the step that all layouts share.

#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Matches the lists `colour_list` and `depth_list` ("timestamp filename" lines, files relative to the
/// folder) one to one into `out.frames`; the association report says what was dropped.
/// @throws std::runtime_error when a list is malformed or nothing matches
void matchLists(const std::string& folder, const std::string& colour_list, const std::string& depth_list,
                double max_difference, DatasetDescription& out);

/// Pairs that somebody else matched, "t file t file" a line, colour first or depth first, into `out.frames`.
/// @throws std::runtime_error naming file and line
void readAssociations(const std::string& folder, const std::string& file, double max_difference,
                      DatasetDescription& out);

/// Last step of every loader: `out.frames` in order of time, stamps to the microsecond, report complete.
void finishFrames(DatasetDescription& out);

}  // namespace roevo
