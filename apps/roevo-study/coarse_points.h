#pragma once
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"
#include "tracking/tracker.h"

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

/// Aligns these points in mode ct and is ROEVO's tracker in everything else: edges (for the keyframe rule),
/// coarse tracking, largest number of points.
class CoarsePointsTracker : public Tracker {
  public:
    /// @param camera  with its lens
    CoarsePointsTracker(CoarsePoints points, const PinholeCamera& camera, const OdometryOptions& options)
        : Tracker(camera, options), kind_(points) {}
    PhotometricPoints choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                   const RowMotion& rows) const override;

  private:
    CoarsePoints kind_;
};

}  // namespace roevo
