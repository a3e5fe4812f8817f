#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "datasets/dataset_reader.h"

namespace roevo {

struct VerifyResult {
    std::size_t frames = 0, depth_values = 0;
};

/// Reads a rawlog back and compares it with the dataset: number of frames, every time stamp, every depth
/// value, the grey image as the odometry will see it, and the intrinsics.
/// @param written  positions in the dataset of the rawlog's frames
/// @throws std::runtime_error naming the first difference.
VerifyResult verifyRawlog(const DatasetReader& dataset, const std::vector<std::size_t>& written,
                          const std::string& rawlog);

}  // namespace roevo
