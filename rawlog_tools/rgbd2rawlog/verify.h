#pragma once
#include <cstddef>
#include <string>

#include "recordings/dataset_reader.h"
#include "rgbd2rawlog/convert.h"

namespace roevo {

struct VerifyResult {
    std::size_t frames = 0, depth_values = 0, imu_samples = 0;
    double lowest_psnr = 0;  ///< dB, of the colour images; 0 when they were stored as they are
};

/// Reads a rawlog back and compares it with the dataset: number of frames, every time stamp, every depth
/// value, the colour image, the grey image as the odometry will see it, the intrinsics, every inertial
/// sample, and the order of time. JPEG images must be what encoding and decoding the originals gives.
/// @param converted  what went into the rawlog
/// @throws std::runtime_error naming the first difference.
VerifyResult verifyRawlog(const DatasetReader& dataset, const ConvertOptions& options,
                          const ConvertResult& converted, const std::string& rawlog);

}  // namespace roevo
