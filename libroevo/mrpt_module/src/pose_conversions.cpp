#include "roevo_mrpt/pose_conversions.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roevo {

Pose toEigen(const mrpt::poses::CPose3D& pose) {
    const auto& R = pose.getRotationMatrix();
    Eigen::Matrix3d rotation;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) rotation(r, c) = R(r, c);
    return {Eigen::Quaterniond(rotation), Eigen::Vector3d(pose.x(), pose.y(), pose.z())};
}

mrpt::poses::CPose3D toMrpt(const Pose& pose) {
    mrpt::math::CMatrixDouble33 R;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) R(r, c) = pose.linear()(r, c);
    const Eigen::Vector3d t = pose.translation();
    return mrpt::poses::CPose3D(R, mrpt::math::CVectorFixedDouble<3>({t.x(), t.y(), t.z()}));
}

Pose sensorFromOptical() {
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return {Eigen::Quaterniond(axes), Eigen::Vector3d::Zero()};
}

mrpt::poses::CPose3D sensorPoseFromOptical(const Pose& T_world_optical) {
    return toMrpt(T_world_optical * sensorFromOptical().inverse());
}

Pose opticalPoseFromSensor(const mrpt::poses::CPose3D& T_world_sensor) {
    return toEigen(T_world_sensor) * sensorFromOptical();
}

mrpt::poses::CPose3D relativePoseOfColour(const Pose& T_depth_colour) {
    return toMrpt(sensorFromOptical() * T_depth_colour);
}

Pose colourFromDepth(const mrpt::poses::CPose3D& relative_pose_of_colour) {
    return toEigen(relative_pose_of_colour).inverse() * sensorFromOptical();
}

mrpt::poses::CPose3DPDFGaussian toMrptGaussian(const Pose& T_world_camera, const Matrix6d& covariance,
                                               const Pose& T_camera_body) {
    const mrpt::poses::CPose3D mean = toMrpt(T_world_camera * T_camera_body);
    const double cos_yaw = std::cos(mean.yaw()), sin_yaw = std::sin(mean.yaw());
    // Keep the inverse below finite at the gimbal lock.
    const double cos_pitch =
        std::copysign(std::max(std::abs(std::cos(mean.pitch())), 1e-6), std::cos(mean.pitch()));
    const double sin_pitch = std::sin(mean.pitch());

    // World-frame angular increments of yaw, pitch and roll: w = A (d_yaw, d_pitch, d_roll) for R = Rz(yaw)
    // Ry(pitch) Rx(roll).
    Eigen::Matrix3d A;
    A.col(0) << 0, 0, 1;
    A.col(1) << -sin_yaw, cos_yaw, 0;
    A.col(2) << cos_yaw * cos_pitch, sin_yaw * cos_pitch, -sin_pitch;

    const Eigen::Vector3d lever = T_world_camera.linear() * T_camera_body.translation();
    Eigen::Matrix3d cross;
    cross << 0, -lever.z(), lever.y(), lever.z(), 0, -lever.x(), -lever.y(), lever.x(), 0;
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>().setIdentity();
    J.topRightCorner<3, 3>() = -cross;  // the body moves by phi x lever
    J.bottomRightCorner<3, 3>() = A.inverse();

    const Matrix6d cov = J * covariance * J.transpose();
    mrpt::math::CMatrixDouble66 out;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) out(r, c) = 0.5 * (cov(r, c) + cov(c, r));
    return mrpt::poses::CPose3DPDFGaussian(mean, out);
}

}  // namespace roevo
