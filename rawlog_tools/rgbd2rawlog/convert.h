#pragma once
#include <string>
#include <vector>

#include "datasets/dataset_reader.h"

namespace roevo {

struct ConvertResult {
    std::vector<std::size_t> written;   ///< positions in the dataset of the frames in the rawlog
    std::vector<std::string> left_out;  ///< one line for each frame that could not be used
};

/// Writes the dataset as a rawlog. Every image is decoded once, so that a damaged one is found now and not by
/// the odometry.
/// @param skip_bad  leave unusable frames out instead of failing
/// @throws std::runtime_error
ConvertResult convertToRawlog(const DatasetReader& dataset, const std::string& rawlog, bool skip_bad);

/// <dir>/<stem>_groundtruth.txt of a rawlog.
std::string groundTruthFileOf(const std::string& rawlog);

}  // namespace roevo
