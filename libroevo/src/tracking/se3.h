#pragma once
#include "roevo/types.h"

namespace roevo {

/// Pose increment of xi = (t, phi): rotation by Rodrigues' formula, Eq. (21), and the translation t as it is
/// (the perturbation of Eq. (22), first order equal to the exponential map). Applied on the left: T <-
/// poseIncrement(xi) * T.
Pose poseIncrement(const Vector6d& xi);

/// The xi that a pose is the increment of.
Vector6d incrementOf(const Pose& pose);

/// Rotation angle of a pose, radians.
double rotationAngle(const Pose& pose);

/// Rotation about the optical axis, rad.
double rollOf(const Pose& pose);

/// The same as cosine and sine: how image directions turn with the pose.
Eigen::Vector2f imageRotation(const Pose& pose);

/// How far a point at `depth` (m) moves in the image between two poses of a camera, px, as an order of
/// magnitude.
double imageMotion(const Pose& a, const Pose& b, double focal_length, double depth);

/// a + share * (b - a) on translation and rotation, for share of any size (prediction uses share > 1).
Pose interpolate(const Pose& a, const Pose& b, double share);

/// Matrix of the cross product.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

}  // namespace roevo
