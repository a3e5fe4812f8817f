#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "roevo/camera/rgbd_frame.h"

namespace roevo {

/// Median of the known depths of an image, in its own units; 0 when there are none.
/// @param depth  CV_16UC1 or CV_32FC1. @param invalid  beside 0 what stands for unknown (CV_16UC1)
double medianDepth(const cv::Mat& depth, std::uint16_t invalid = 0);

/// Whether the median depth of an image is one that sensors see: 0.1 to 20 m. Beyond, the scale is wrong, not
/// the room.
bool isPlausibleMedianDepth(double metres);

/// What scales in use among sensors would make of a median in PNG units, where that is plausible; nearest to
/// 2 m first, and "" where none is.
std::string likelyDepthScales(double median_units);

/// PNG units per metre for a unit in metres: whole numbers are meant where a float stands for them.
double unitsPerMetre(double metres_per_unit);

/// Depths in floats as 16-bit units, rounded; what is no depth becomes 0, and so does what 16 bits cannot
/// hold.
/// @param depth  CV_32FC1. @param too_far  is set to how many were beyond
cv::Mat depthInUnits(const cv::Mat& depth, double units, std::size_t& too_far);

/// In words: so many depths were beyond 13.107 m.
std::string tooFarText(std::size_t count);

/// Empty when the depth of a frame is of a plausible scale (or there is none), else one line that says by
/// which factor it is likely to be wrong.
std::string depthScaleFault(const RgbdFrame& frame);

}  // namespace roevo
