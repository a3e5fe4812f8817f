#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/camera/rgbd_frame.h"
#include "roevo/edges/organized_edges.h"
#include "roevo/tracking/image_pyramid.h"
#include "roevo/tracking/rolling_shutter.h"
#include "roevo/types.h"

namespace roevo {

/// What a frame leaves behind, so that it can still become a keyframe when the next one turns out to see much
/// less.
struct FrameData {
    RgbdFrame images;  // copies: the caller's buffers may be used again
    cv::Mat undistorted;
    OrganizedEdges edges;
    ImagePyramid pyramid;
    RowMotion row_motion;
    Pose T_world_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();
    Matrix6d relative_covariance = Matrix6d::Zero();  ///< of the motion since the keyframe, same axes
    double matched_ratio = 0;
    bool may_be_keyframe = false;  // tracked, and not one yet
};

}  // namespace roevo
