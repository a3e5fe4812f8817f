#pragma once
#include <functional>
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"
#include "rgbd2rawlog/selection.h"

namespace roevo {

struct ConvertOptions {
    FrameSelection selection;
    bool externalize_depth = false;
    int jpeg_quality = 0;   ///< 1 to 100: colour becomes JPEG, lossy; 0: it stays as it is
    bool skip_bad = false;  ///< leave unusable frames out instead of failing
};

/// What went into a rawlog, for the user and for the verification.
struct ConvertResult {
    std::vector<std::size_t> written;   ///< positions in the dataset of the frames in the rawlog
    std::vector<std::string> left_out;  ///< one line for each frame that could not be used
    std::vector<ImuSample> imu;         ///< inertial samples in the rawlog
    double seconds = 0;                 ///< writing and decoding
    double decode_seconds = 0;          ///< decoding the images alone, which no converter can do without
};

/// Writes the dataset as a rawlog. Every image is decoded once, ahead in a thread of its own, so that a
/// damaged one is found now and not by the odometry. Inertial samples between the limits of time go between
/// the frames, in the order of time.
/// @param check  called with the result and the path of the finished rawlog before it appears under its name;
///               what it throws leaves nothing behind
/// @throws std::runtime_error; Interrupted after a signal
ConvertResult convertToRawlog(const DatasetReader& dataset, const std::string& rawlog,
                              const ConvertOptions& options,
                              const std::function<void(const ConvertResult&, const std::string&)>& check);

}  // namespace roevo
