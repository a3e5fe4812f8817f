#pragma once
#include <string>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"

namespace roevo {

/// Why a frame cannot be processed, in words; empty when it can.
std::string faultOf(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp);

}  // namespace roevo
