#pragma once
#include <cstddef>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>

namespace roevo {

constexpr double kMovieRate = 30;  ///< pictures per second

/// Writes an MP4 that appears when whole, H.264 where OpenCV's FFmpeg has it, else MPEG-4.
/// @param size   even width and height, pixels
/// @param draw   gives the picture of a number below `count`, CV_8UC3 of that size
/// @throws std::runtime_error when it cannot be written, or when there is no encoder
void writeMovie(const std::string& file, cv::Size size, std::size_t count,
                const std::function<cv::Mat(std::size_t)>& draw);

}  // namespace roevo
