#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/options.h"

namespace roevo {

/// Depth of the foreground at an edge.
struct EdgeDepth {
    float depth = 0;         ///< m along the optical axis; 0 where unknown
    bool occluding = false;  ///< the patch also holds a background behind a depth jump
};

/// An occluding edge belongs to the foreground: sorts the valid depths of the patch around (u, v), cuts at
/// the first relative jump and evaluates the plane through the near ones (inverse depth is linear in the
/// image) at (u, v), never farther beyond their range than that is long.
/// @param depth  CV_32FC1, m, 0 where unknown
/// @param u, v   sub-pixel position in `depth`, px
EdgeDepth foregroundDepth(const cv::Mat& depth, float u, float v, const EdgeOptions& edges,
                          const SensorOptions& sensor);

}  // namespace roevo
