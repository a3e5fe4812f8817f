#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/options.h"

namespace roevo {

/// Depth (m, along the optical axis) of the foreground at an edge; 0 where unknown. An occluding edge belongs
/// to the foreground: of the depths in the patch around (u, v) (of a large one, some), those that follow the
/// nearest one without a jump; the plane through them (inverse depth is linear in the image) at (u, v), never
/// farther beyond their range than that is long.
/// @param depth  CV_32FC1, m, 0 where unknown
/// @param u, v   sub-pixel position in `depth`, px
float foregroundDepth(const cv::Mat& depth, float u, float v, const EdgeOptions& edges,
                      const SensorOptions& sensor);

}  // namespace roevo
