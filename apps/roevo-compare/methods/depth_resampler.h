#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"

namespace roevo {

/// The ideal camera of the given size with fx = fy and a centred principal point that sees, undistorted, all
/// that `camera` sees (and nothing where the proportions differ): for methods that know a field of view only.
PinholeCamera centredCamera(const PinholeCamera& camera, int width, int height);

/// Depth images of a real camera as an ideal one at the same place would have measured them. Surfaces are
/// interpolated, steps between them are not.
class DepthResampler {
  public:
    /// @param source  may be distorted
    /// @param target  must not be
    /// @param sensor  depths outside of its min_depth to depth_limit become unknown
    DepthResampler(const PinholeCamera& source, const PinholeCamera& target, const SensorOptions& sensor);

    /// @param depth    CV_32FC1 of the source's size, m, 0 where unknown
    /// @param unknown  what marks unknown depth in the result
    /// @return CV_32FC1 of the target's size, in `buffer`; always its own memory
    const cv::Mat& apply(const cv::Mat& depth, cv::Mat& buffer, float unknown = 0) const;

  private:
    cv::Mat position_;  ///< CV_32FC2 of the target's size: pixel of the source; negative: not seen
    float min_depth_, max_depth_;
};

/// Pixels with a depth above 0 (NaN is none).
int countKnown(const cv::Mat& depth);

}  // namespace roevo
