#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// Resamples images of a distorted camera as the ideal camera of the same intrinsics would have seen them.
class Undistorter {
  public:
    explicit Undistorter(const PinholeCamera& camera);

    /// Bilinear, into `buffer`, which is returned; or `image` itself when the lens is ideal.
    const cv::Mat& apply(const cv::Mat& image, cv::Mat& buffer) const;

    bool isIdentity() const { return offset_.empty(); }

  private:
    int width_ = 0, height_ = 0;
    std::vector<std::int32_t> offset_;  ///< of each pixel, as kernels::Remap has them
    std::vector<std::int16_t> fraction_;
};

}  // namespace roevo
