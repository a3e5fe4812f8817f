#pragma once
#include <opencv2/core/mat.hpp>

#include "kernels/kernels.h"
#include "roevo/options.h"

namespace roevo {

/// Depths of the foreground at the edges of one image. An occluding edge belongs to the foreground: of the
/// depths in a square around a point (of a large one, some), those that follow the nearest one without a jump
/// count; the depth is that of the plane through them (inverse depth is linear in the image), never farther
/// beyond their range than that is long.
class ForegroundDepth {
  public:
    ForegroundDepth() = default;  ///< of an image without depth
    /// Where only every so many pixels have a depth (a depth camera of fewer pixels registered to a colour
    /// image, a lidar), squares are wider than the options say.
    /// @param depth  CV_32FC1, m, 0 where unknown; may be empty. Its pixels are not copied.
    ForegroundDepth(const cv::Mat& depth, const EdgeOptions& edges, const SensorOptions& sensor);

    /// @param u, v  sub-pixel position in the depth image, px
    /// @return m, along the optical axis; 0 where unknown
    float at(float u, float v) const;

  private:
    struct Offsets;
    struct Copy;
    void lookForKnown(int x, int y, Offsets& rows, Offsets& columns) const;
    kernels::DepthSquare copy(int x, int y, Copy& to) const;

    cv::Mat depth_;
    kernels::DepthLimits limits_{};
    int radius_ = 0;  // px
    bool sparse_ = false;
};

}  // namespace roevo
