#pragma once
#include <opencv2/core/types.hpp>
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Sizes of the first colour or depth image that can be decoded. @throws the first one's fault when none can
cv::Size colourSize(const std::vector<DatasetEntry>& frames);
cv::Size depthSize(const std::vector<DatasetEntry>& frames);

}  // namespace roevo
