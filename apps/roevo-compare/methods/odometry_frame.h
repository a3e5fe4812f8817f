#pragma once
#include <string>
#include <utility>

#include "method.h"
#include "roevo/odometry.h"

namespace roevo {

/// What an odometry made of a frame, but for the times.
/// @param started  whether it was initialised before; every start but the first means that the camera's
/// motion since the last frame is not known
inline MethodFrame toMethodFrame(const FrameResult& result, bool& started) {
    MethodFrame out;
    if (result.hasPose()) out.T_world_camera = result.T_world_camera;
    out.tracked = result.status == FrameStatus::kOk ||
                  (result.status == FrameStatus::kInitialised && !std::exchange(started, true));
    if (!out.tracked) out.reason = std::string(toString(result.status)) + ": " + result.reason;
    return out;
}

}  // namespace roevo
