#pragma once
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "tracking/fault.h"

namespace roevo {

inline constexpr const char* kTimeBackward = "time stamp goes backward";

/// Why a frame cannot be processed.
/// @param last_timestamp  s, of the frame before
[[nodiscard]] Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp);

/// Whether two grey images are the same to the last bit: a camera with noise never takes two such images.
bool sameBytes(const cv::Mat& a, const cv::Mat& b);

}  // namespace roevo
