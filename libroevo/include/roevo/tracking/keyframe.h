#pragma once
#include "roevo/tracking/edge_points.h"
#include "roevo/tracking/photometric.h"

namespace roevo {

/// The reference that frames are tracked against.
struct Keyframe {
    int id = 0;
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< of T_world_camera, as in FrameResult
    EdgePoints3D edges;
    /// Of each edge point: frames that found it, frames that looked for it.
    std::vector<std::uint16_t> hits, trials;
    PhotometricPoints photometric;
    RowMotion row_motion;     ///< that `edges` were lifted with
    double median_depth = 0;  ///< m
};

}  // namespace roevo
