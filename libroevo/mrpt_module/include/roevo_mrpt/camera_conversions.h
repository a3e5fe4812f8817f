#pragma once
#include <mrpt/img/TCamera.h>

#include <string>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

mrpt::img::TCamera toMrptCamera(const PinholeCamera& camera, const std::string& name);

/// @param what  how to call this camera in an error ("depth camera", "colour camera")
/// @throws std::runtime_error when it has no intrinsics or a lens model other than none or plumb_bob with
/// five terms.
PinholeCamera fromMrptCamera(const mrpt::img::TCamera& camera, const std::string& what);

}  // namespace roevo
