#pragma once
#include <limits>
#include <optional>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "tracking/fault.h"

namespace roevo {

inline constexpr const char* kTimeBackward = "time stamp goes backward";

/// Why a frame cannot be processed.
/// @param last_timestamp  s, of the frame before
[[nodiscard]] Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp);

/// Whether time stamps can be believed, frame after frame.
class StampCheck {
  public:
    /// Why a frame of this time cannot be processed; without a fault it is the last one from now on. A leap
    /// ahead is not believed until the next frame comes soon after it.
    [[nodiscard]] Fault take(double timestamp);
    double last() const { return last_; }

  private:
    double last_ = -std::numeric_limits<double>::infinity();  ///< s, of those without a fault
    std::optional<double> leap_;  ///< s, stamp of the frame before, if it was not believed
};

/// Whether two grey images are the same to the last bit: a camera with noise never takes two such images.
bool sameBytes(const cv::Mat& a, const cv::Mat& b);

}  // namespace roevo
