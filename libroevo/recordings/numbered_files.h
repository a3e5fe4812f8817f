#pragma once
/// Folders of images whose names tell what belongs together and when it was, without lists.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// The number that a word of digits only stands for, padded with zeros or not.
std::optional<long long> wholeNumber(const std::string& word);

/// Image files by name without ending.
using NamedImages = std::map<std::string, std::string>;

/// The images of a folder (depth also as .npy and .exr); hidden files, of file managers, are none.
/// @throws std::runtime_error when the folder cannot be read
NamedImages imagesIn(const std::filesystem::path& folder);

/// @param place  their folder, for the error. @throws std::runtime_error when there are none
void requireImages(const NamedImages& images, const std::string& place);

/// Pairs images by what their names tell into `out.frames`, and counts those without a partner. Their time is
/// a date, else the last number in a name or, where others go back in its order, the last one that changes:
/// with a point in it ("1305031453.359684"), or of at least ten digits, or where neighbours are more than
/// 1000 apart, in the unit that unitOfImages() tells; such are paired by nearest time. Smaller ones
/// ("frame_0012", "12.color") are frames at `rate`, and paired where they are the same.
/// @param rate  Hz; becomes `out.frame_rate` where names are numbers
/// @return in words: what the names were taken for
/// @throws std::runtime_error when nothing pairs, or names hold no numbers, both kinds, or several that
/// differ in what comes first
std::string pairByName(const NamedImages& colours, const NamedImages& depths, double rate,
                       double max_difference, DatasetDescription& out);

}  // namespace roevo
