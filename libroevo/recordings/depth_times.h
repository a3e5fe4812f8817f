#pragma once
/// A scan of a rawlog has one time, that of its colour image. Where the depth images of a dataset have stamps
/// of their own, they are kept in a text file beside the rawlog: "colour stamp, depth stamp" a line.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo {

/// <dir>/<stem>_depth_times.txt of a rawlog.
std::string depthTimesFile(const std::string& rawlog);

/// The file's text for these frames of the dataset, or "" when no depth stamp differs from its colour's.
std::string depthTimesText(const DatasetReader& dataset, const std::vector<std::size_t>& frames);

struct DepthTimes {
    std::string file;                ///< empty when there is none
    std::map<double, double> times;  ///< s: colour stamp -> depth stamp
    std::string fault;               ///< why the file cannot be used, or empty

    /// The depth stamp of the frame with this colour stamp.
    std::optional<double> of(double colour_timestamp) const;
};

/// Reads the file beside a rawlog; a fault in it is told and not thrown.
DepthTimes readDepthTimes(const std::string& rawlog);

/// Why a folder with these stamps of its pairs (ascending in colour) would not be read as the same pairs, or
/// "": some are missing, not ascending, or other images are closer.
std::string depthTimesFault(const std::vector<double>& colour,
                            const std::vector<std::optional<double>>& depth);

}  // namespace roevo
