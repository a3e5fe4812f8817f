#pragma once
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"

namespace mrpt::obs {
class CObservation3DRangeScan;
}

namespace roevo {

/// The colour camera of a scan, in which frames made from it live.
/// @throws std::runtime_error "no intrinsics …" when it is empty, or when its size is not the image's.
PinholeCamera colourCameraOf(const mrpt::obs::CObservation3DRangeScan& scan);

/// Turns a scan into a frame for the odometry: depth in metres registered to the colour camera (untouched
/// when both cameras coincide), ranges along the ray turned into depth, 8-bit grey. External images are
/// decoded here and not kept by the scan.
/// @throws std::runtime_error in one line: no depth, no image, a missing or damaged file (named), no
/// intrinsics, sizes that do not fit the intrinsics.
RgbdFrame toRgbdFrame(const mrpt::obs::CObservation3DRangeScan& scan);

}  // namespace roevo
