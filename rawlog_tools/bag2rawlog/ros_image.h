#pragma once
#include <sensor_msgs/Image.h>

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>

namespace roevo {

bool isColourEncoding(const std::string& encoding);  ///< rgb8, bgr8, rgba8, bgra8, 8UC3
bool isGreyEncoding(const std::string& encoding);    ///< mono8, 8UC1
bool isDepthEncoding(const std::string& encoding);   ///< 16UC1, 32FC1

/// A colour or grey message as CV_8UC3 (BGR) or CV_8UC1. @throws std::runtime_error in one line.
cv::Mat colourImageOf(const sensor_msgs::Image& message);

/// Metres per unit of what depthImageOf() makes of this encoding. Millimetres stay what they are. Metres
/// become fifths of a millimetre, TUM's unit: that holds whole millimetres (what most drivers start from)
/// without loss and rounds others by 0.1 mm at most.
float depthUnitOf(const std::string& encoding);

/// A depth message as CV_16UC1 in depthUnitOf() its encoding; 0 where it has no depth.
/// @param too_far  increased by the number of depths that do not fit (beyond 13.107 m for 32FC1), which
/// become 0
/// @throws std::runtime_error in one line.
cv::Mat depthImageOf(const sensor_msgs::Image& message, std::size_t& too_far);

}  // namespace roevo
