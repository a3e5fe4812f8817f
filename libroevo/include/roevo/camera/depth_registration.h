#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace roevo {

/// Registers a depth image to the colour camera: every depth pixel is back-projected through the depth
/// camera, moved by `T_colour_depth` and projected (with the colour lens's distortion) into the colour image;
/// where several fall on one pixel the nearest wins (z-buffer).
/// @param depth  CV_32FC1 metres along the optical axis, 0 where unknown, of size `depth_camera`
/// @return CV_32FC1 of size `colour_camera`, 0 where nothing fell.
/// @throws std::invalid_argument for a camera without size or intrinsics, an image of another size or type
/// than the depth camera's, and a pose that is not finite
cv::Mat registerDepth(const cv::Mat& depth, const PinholeCamera& depth_camera,
                      const PinholeCamera& colour_camera, const Pose& T_colour_depth);

/// Converts ranges along the viewing ray into depths along the optical axis, in place (CV_32FC1, metres).
/// @throws std::invalid_argument as registerDepth()
void rangeToDepth(cv::Mat& range, const PinholeCamera& depth_camera);

}  // namespace roevo
