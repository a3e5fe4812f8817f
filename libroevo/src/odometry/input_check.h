#pragma once
#include <optional>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "tracking/fault.h"

namespace roevo {

/// Why a frame cannot be processed.
/// @param last_timestamp  s, of the frame before
[[nodiscard]] Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp);

/// Makes time of stamps, which goes on when the clock is set back. One damaged stamp far ahead would have all
/// frames after it rejected, as going backward, and a clock that is set back all until it has caught up: a
/// stamp that leaps by more than a minute, ahead or back, is not believed until the next one comes soon after
/// it. Time is the stamps', to the last bit, until a clock is set back.
class FrameClock {
  public:
    /// Time of a stamp, s. @param last  time of the frame before; infinite where there was none
    double timeOf(double stamp, double last);
    /// Why the stamp that timeOf() was asked for last is not to be believed.
    const Fault& leap() const { return leap_fault_; }
    /// The stamp of a frame that was at a time.
    double stampAt(double time) const;

  private:
    struct Setting {
        double since, ahead;  ///< s; time, and how far it is ahead of the stamps
    };
    std::vector<Setting> set_back_;
    std::optional<double> leap_;  ///< s, stamp of the frame before, if it was not believed
    Fault leap_fault_;
};

/// Whether two grey images are the same to the last bit: a camera with noise never takes two such images.
bool sameBytes(const cv::Mat& a, const cv::Mat& b);

}  // namespace roevo
