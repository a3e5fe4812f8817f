#pragma once
#include <opencv2/core/mat.hpp>
#include <vector>

#include "indexing.h"

namespace roevo {

/// Grey image pyramid, each level the mean of 2x2 pixels of the one below (PinholeCamera::atPyramidLevel says
/// where pixels move).
class ImagePyramid {
  public:
    /// Level 0 shares the memory of `grey` (CV_8UC1).
    void build(const cv::Mat& grey, int levels);
    const cv::Mat& level(int i) const { return at(levels_, i); }
    int numLevels() const { return static_cast<int>(levels_.size()); }

  private:
    std::vector<cv::Mat> levels_;
};

}  // namespace roevo
