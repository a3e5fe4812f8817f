#pragma once
#include "roevo/odometry_stages.h"

namespace roevo {

/// Refines a coarse pose by fine tracking or by what stands in for it; `fine` holds the edges associated at
/// the pose found.
FineResult refinePose(const OdometryStages& stages, FineTracker& fine, const Keyframe& keyframe,
                      const FineFrame& frame, const CoarseResult& aligned, const PosePrior& prior,
                      const RollingShutter& shutter);

}  // namespace roevo
