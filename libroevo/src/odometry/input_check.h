#pragma once
#include <optional>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "tracking/fault.h"

namespace roevo {

/// Why a frame cannot be processed.
/// @param last_timestamp  s, of the frame before
[[nodiscard]] Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp);

/// One damaged stamp far ahead would have all frames after it rejected, as going backward. A frame that leaps
/// ahead is not believed until the next one comes soon after it.
class LeapCheck {
  public:
    /// @param last_timestamp  s, of the last frame that was believed
    [[nodiscard]] Fault check(double timestamp, double last_timestamp);

  private:
    std::optional<double> leap_;  ///< s, stamp of the frame before, if it was not believed
};

/// Whether two grey images are the same to the last bit: a camera with noise never takes two such images.
bool sameBytes(const cv::Mat& a, const cv::Mat& b);

}  // namespace roevo
