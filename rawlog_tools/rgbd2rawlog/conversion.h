#pragma once
#include <string>

#include "recordings/dataset_reader.h"
#include "rgbd2rawlog/convert.h"

namespace roevo {

/// From a recording to a rawlog with all that belongs beside it, as rgbd2rawlog and bag2rawlog do it.
struct ConversionSettings {
    std::string input, output;
    DatasetOptions dataset;  ///< tolerate_missing follows convert.skip_bad
    ConvertOptions convert;
    bool verify = false;
};

/// Writes the rawlog, <stem>_groundtruth.txt and <stem>_depth_times.txt and tells on stdout what was done.
/// @param program  name for warnings
/// @throws std::runtime_error in one line; nothing is left then
void convertRecording(const char* program, const ConversionSettings& settings);

}  // namespace roevo
