#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace roevo {

inline constexpr std::string_view kNpyHead = "\x93NUMPY";

/// A numpy array (format 1 to 3) of two dimensions, or of three with one channel, as an image: <u2 as
/// CV_16UC1, <f4 and <f8 as CV_32FC1.
/// @throws std::runtime_error naming the file: another kind of array, or not all of it
cv::Mat decodeNpy(const std::vector<std::uint8_t>& bytes, const std::string& file);

}  // namespace roevo
