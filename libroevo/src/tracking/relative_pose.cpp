#include "tracking/relative_pose.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "tracking/se3.h"

namespace roevo {
namespace {

// One sigma: between real keyframes 0.1 to 0.4 m apart, poses were 1 to 2 cm and 0.4 to 1.4 degrees off where
// edges say 1 mm
constexpr double kViewsDiffer = 0.01;         ///< m
constexpr double kViewsTurn = 0.5 * kDegree;  ///< rad

}  // namespace

void addErrorsFromElsewhere(PoseUncertainty& uncertainty) {
    auto variances = uncertainty.common.diagonal().array();
    variances.head<3>() += kViewsDiffer * kViewsDiffer;
    variances.tail<3>() += kViewsTurn * kViewsTurn;
}

double worstSigma(const Eigen::Matrix3d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
}

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

RelativePose compose(const RelativePose& keyframe, const RelativePose& camera) {
    return {keyframe.keyframe, keyframe.T_keyframe_camera * camera.T_keyframe_camera,
            sum(keyframe.uncertainty, carriedTo(camera.T_keyframe_camera), camera.uncertainty)};
}

RelativePose changeReference(const RelativePose& pose, const RelativePose& new_keyframe, int id) {
    const Pose T = new_keyframe.T_keyframe_camera.inverse() * pose.T_keyframe_camera;
    return {id, T, sum(new_keyframe.uncertainty, -carriedTo(T), pose.uncertainty)};
}

}  // namespace roevo
