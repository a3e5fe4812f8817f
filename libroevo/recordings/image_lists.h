#pragma once
/// Which colour image goes with which depth image: the step that all layouts share.

#include <string>
#include <vector>

#include "recordings/dataset_reader.h"
#include "recordings/text_list.h"

namespace roevo {

/// Matches images (files that can be opened), ascending in time, one to one into `out.frames`; the
/// association report says what was dropped.
/// @throws std::runtime_error when nothing matches
void matchEntries(const std::vector<ListEntry>& colours, const std::vector<ListEntry>& depths,
                  double max_difference, DatasetDescription& out);

/// The same with what two lists in the folder say ("timestamp filename" lines).
/// @throws std::runtime_error when a list is malformed or nothing matches
void matchLists(const std::string& colour_list, const std::string& depth_list, double max_difference,
                DatasetDescription& out);

/// Pairs that somebody else matched, "t file t file" a line, colour first or depth first, into `out.frames`.
/// @param file  relative to the folder, as the images in it are, or a whole path
/// @throws std::runtime_error naming file and line
void readAssociations(const std::string& file, double max_difference, DatasetDescription& out);

/// Last step of every loader: `out.frames` in order of time, stamps to the microsecond, report complete.
void finishFrames(DatasetDescription& out);

}  // namespace roevo
