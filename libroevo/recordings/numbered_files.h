#pragma once
/// Folders of numbered images, without lists.

#include <filesystem>
#include <optional>
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// The number that a word of digits only stands for, padded with zeros or not.
std::optional<long long> wholeNumber(const std::string& word);

/// Pairs the images of two folders that have the same name (but for its ending) into `out.frames`, and counts
/// those without a partner. The time is told by the name: "1305031453.359684" are seconds; whole numbers of
/// at least ten digits are seconds, milli-, micro- or nanoseconds since 1970, whichever gives a year before
/// 2100; smaller ones, also after other letters ("frame_0012"), are frames at `rate`.
/// @param rate  Hz
/// @return in words: what the names were taken for
/// @throws std::runtime_error when a folder is empty, nothing pairs, or a name holds no number
std::string pairByName(const std::filesystem::path& colour_folder, const std::filesystem::path& depth_folder,
                       double rate, DatasetDescription& out);

}  // namespace roevo
