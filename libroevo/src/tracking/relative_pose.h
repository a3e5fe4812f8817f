#pragma once
#include "roevo/types.h"

namespace roevo {

/// A camera's pose relative to a keyframe. Only Trajectory knows where that is in the world.
struct RelativePose {
    int keyframe = -1;
    Pose T_keyframe_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< position, then orientation, along the camera's axes
};

/// The same pose relative to another keyframe, whose own pose against the first one is known. The errors of
/// both add up, though they share those of the first keyframe: what comes out is too large rather than too
/// small.
RelativePose changeReference(const RelativePose& pose, const RelativePose& new_keyframe, int id);

}  // namespace roevo
