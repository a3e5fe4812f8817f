#pragma once
#include "roevo/camera/pinhole_camera.h"
#include "roevo/odometry_stages.h"
#include "roevo/options.h"

namespace roevo {

/// What coarse tracking aligns: the four columns of the paper's table, in its order.
enum class CoarsePoints {
    kDso,        ///< selectDsoPixels(), patches along the image's axes
    kCanny,      ///< selectCannyPixels(), evenly subsampled, patches along the image's axes
    kOrganized,  ///< points of organized edges, patches along the image's axes
    kOriented    ///< the same with patches along the gradient that turn with the camera: ROEVO's own
};
inline constexpr CoarsePoints kAllCoarsePoints[] = {CoarsePoints::kDso, CoarsePoints::kCanny,
                                                    CoarsePoints::kOrganized, CoarsePoints::kOriented};
const char* label(CoarsePoints points);

/// An odometry in mode ct that aligns these points and is ROEVO's in everything else: edges (for the keyframe
/// rule), coarse tracker, largest number of points.
/// @param camera  with its lens
OdometryStages coarseStages(CoarsePoints points, const PinholeCamera& camera, const OdometryOptions& options);

}  // namespace roevo
