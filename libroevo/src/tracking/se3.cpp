#include "tracking/se3.h"

#include <Eigen/Geometry>

namespace roevo {

Pose poseIncrement(const Vector6d& xi) {
    Pose increment = Pose::Identity();
    const Eigen::Vector3d phi = xi.tail<3>();
    const double angle = phi.norm();
    if (angle > 1e-12) increment.setRotation(Eigen::AngleAxisd(angle, phi / angle));
    increment.translation() = xi.head<3>();
    return increment;
}

Vector6d incrementOf(const Pose& pose) {
    const Eigen::AngleAxisd turn(pose.linear());
    Vector6d xi;
    xi << pose.translation(), turn.angle() * turn.axis();
    return xi;
}

double rotationAngle(const Pose& pose) {
    return Eigen::AngleAxisd(pose.linear()).angle();
}

double rollOf(const Pose& pose) {
    const Eigen::Matrix3d& R = pose.linear();
    return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
}

Eigen::Vector2f imageRotation(const Pose& pose) {
    const Eigen::Matrix3d& R = pose.linear();
    return Eigen::Vector2d(R(0, 0) + R(1, 1), R(1, 0) - R(0, 1)).normalized().cast<float>();
}

double imageMotion(const Pose& a, const Pose& b, double focal_length, double depth) {
    const Pose between = b * a.inverse();
    return focal_length * (rotationAngle(between) + between.translation().norm() / depth);
}

Pose interpolate(const Pose& a, const Pose& b, double share) {
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.linear().transpose() * b.linear()));
    Pose between = Pose::Identity();
    between.setRotation(a.rotation() * Eigen::AngleAxisd(share * turn.angle(), turn.axis()));
    between.translation() = a.translation() + share * (b.translation() - a.translation());
    return between;
}

}  // namespace roevo
