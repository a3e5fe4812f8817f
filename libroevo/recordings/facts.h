#pragma once
#include <cstddef>
#include <opencv2/core/types.hpp>
#include <string>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// "640x480".
std::string sizeText(const cv::Size& size);

/// What makes a wrong scale, rate or camera seen although all can be read, in one line: "60 pairs of 640x480
/// (depth 320x288), fx 613 fy 613 cx 320 cy 240, 30.0 Hz, no lens distortion, median depth 1.9 m".
/// @param pairs  0: not known. @param step  s, from one frame to the next; 0: not known
/// @param median_depth  m, of the first image that holds any
std::string factsText(std::size_t pairs, const PinholeCamera& camera, const cv::Size& depth, double step,
                      double median_depth);

}  // namespace roevo
