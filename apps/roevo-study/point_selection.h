#pragma once
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/gradient.h"
#include "roevo/options.h"
#include "tracking/edge_points.h"

namespace roevo {

/// Pixels for photometric alignment as DSO chooses its candidates (Engel et al., PAMI 2018, Sec. 3.2): in
/// every block of d x d pixels the one with the greatest gradient, if that is above the median of its region
/// of 32 x 32 pixels by 7 grey levels per pixel; where there is none, again in blocks of 2d and 4d with
/// thresholds lowered to 3/4 and 9/16. d is found by bisection, the smallest that gives no more than `wanted`
/// pixels.
/// @return in no particular order but always the same; none closer than EdgeMask::kBorder to the image's
/// border
std::vector<cv::Point> selectDsoPixels(const Gradient& gradient, int wanted);

/// All pixels that Canny finds, in raster order, nothing done to them; thresholds as EdgeExtractor has them
/// for a first image.
std::vector<cv::Point> selectCannyPixels(const Gradient& gradient, const EdgeOptions& options);

/// The pixels with depth as points that samplePhotometricPoints() takes: patches along the image's axes
/// (their gradient is said to be along x), depth and weights as liftEdges() gives them, but every point for
/// itself.
/// @param depth   raw, of `camera` with its lens; the pixels are ideal ones
/// @param rows    motion of the camera over the rows
EdgePoints3D liftPixels(const std::vector<cv::Point>& pixels, const Gradient& gradient, const cv::Mat& depth,
                        const PinholeCamera& camera, const RowMotion& rows, const EdgeOptions& edge_options,
                        const SensorOptions& sensor);

}  // namespace roevo
