#include "tracking/relative_pose.h"

#include "tracking/se3.h"

namespace roevo {

Matrix6d turnedBy(const Eigen::Matrix3d& R) {
    Matrix6d both = Matrix6d::Zero();
    both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
    return both;
}

Matrix6d carriedTo(const Pose& T_reference_camera) {
    const Eigen::Matrix3d R = T_reference_camera.linear().transpose();
    Matrix6d carried = turnedBy(R);
    carried.topRightCorner<3, 3>() = -R * skew(T_reference_camera.translation());
    return carried;
}

namespace {

/// @param sign  of the reference's errors in the pose
PoseUncertainty sum(const PoseUncertainty& reference, const Matrix6d& carried, double sign,
                    const PoseUncertainty& own) {
    PoseUncertainty out;
    out.independent = own.independent + carried * reference.independent * carried.transpose();
    auto a = reference.influences.begin();
    auto b = own.influences.begin();
    while (a != reference.influences.end() || b != own.influences.end()) {
        const bool first =
            a != reference.influences.end() && (b == own.influences.end() || a->cluster <= b->cluster);
        const bool second =
            b != own.influences.end() && (a == reference.influences.end() || b->cluster <= a->cluster);
        EdgeInfluence both{first ? a->cluster : b->cluster, Vector6d::Zero()};
        if (first) both.moved += sign * (carried * (a++)->moved);
        if (second) both.moved += (b++)->moved;
        out.influences.push_back(both);
    }
    return out;
}

}  // namespace

RelativePose compose(const RelativePose& keyframe, const RelativePose& camera) {
    return {keyframe.keyframe, keyframe.T_keyframe_camera * camera.T_keyframe_camera,
            sum(keyframe.uncertainty, carriedTo(camera.T_keyframe_camera), 1, camera.uncertainty)};
}

RelativePose changeReference(const RelativePose& pose, const RelativePose& new_keyframe, int id) {
    const Pose T = new_keyframe.T_keyframe_camera.inverse() * pose.T_keyframe_camera;
    return {id, T, sum(new_keyframe.uncertainty, carriedTo(T), -1, pose.uncertainty)};
}

}  // namespace roevo
