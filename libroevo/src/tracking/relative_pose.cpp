#include "tracking/relative_pose.h"

#include "tracking/se3.h"

namespace roevo {

RelativePose changeReference(const RelativePose& pose, const RelativePose& new_keyframe, int id) {
    RelativePose out;
    out.keyframe = id;
    out.T_keyframe_camera = new_keyframe.T_keyframe_camera.inverse() * pose.T_keyframe_camera;
    // An error of the new keyframe's pose moves the camera the other way; of its orientation, the more the
    // further off
    const Eigen::Matrix3d R = out.T_keyframe_camera.linear().transpose();
    Matrix6d carried = Matrix6d::Zero();
    carried.topLeftCorner<3, 3>() = carried.bottomRightCorner<3, 3>() = R;
    carried.topRightCorner<3, 3>() = -R * skew(out.T_keyframe_camera.translation());
    out.covariance = pose.covariance + carried * new_keyframe.covariance * carried.transpose();
    return out;
}

}  // namespace roevo
