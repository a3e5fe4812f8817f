#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// Resamples images of a distorted camera as the ideal camera of the same intrinsics would have seen them.
class Undistorter {
  public:
    explicit Undistorter(const PinholeCamera& camera);

    /// Bilinear, into `buffer`, which is returned; or `image` itself when the lens is ideal.
    const cv::Mat& apply(const cv::Mat& image, cv::Mat& buffer) const;

    bool isIdentity() const { return map_.empty(); }

  private:
    cv::Mat map_, fractions_;  ///< fixed-point maps of cv::remap
};

}  // namespace roevo
