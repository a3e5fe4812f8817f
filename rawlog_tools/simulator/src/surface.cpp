#include "surface.h"

#include <cmath>

#include "roevo/types.h"

namespace roevo::simulator {
namespace {

/// The horizontal and the vertical coordinate of a box face, with the sign that keeps pictures unmirrored
/// from outside.
struct BoxAxes {
    int u, v;
    double u_sign;
};

BoxAxes boxAxes(int face) {
    const int axis = face / 2;
    const double side = face % 2 ? 1 : -1;
    if (axis == 0) return {1, 2, side};
    if (axis == 1) return {0, 2, -side};
    return {0, 1, side};
}

}  // namespace

int faceCount(Shape shape) {
    switch (shape) {
        case Shape::kBox:
            return 6;
        case Shape::kCylinder:
            return 3;
        default:
            return 1;
    }
}

FacePoint faceExtent(const Primitive& primitive, int face) {
    const Eigen::Vector3f half = primitive.half_size.cast<float>();
    FacePoint extent;
    extent.face = face;
    const float pi = static_cast<float>(kPi);
    switch (primitive.shape) {
        case Shape::kQuad:
            extent.half_u = half.x(), extent.half_v = half.y();
            break;
        case Shape::kBox: {
            const BoxAxes axes = boxAxes(face);
            extent.half_u = half[axes.u], extent.half_v = half[axes.v];
            break;
        }
        case Shape::kSphere:
            extent.half_u = pi * half.x(), extent.half_v = 0.5f * pi * half.z();
            break;
        case Shape::kCylinder:
            extent.half_u = face == 0 ? pi * half.x() : half.x();
            extent.half_v = face == 0 ? half.z() : half.y();
            break;
    }
    return extent;
}

FacePoint facePointOf(const Primitive& primitive, const Eigen::Vector3d& unit,
                      const Eigen::Vector3d& normal) {
    int face = 0;
    double a = unit.x(), b = unit.y();  // -1..1 over the face
    switch (primitive.shape) {
        case Shape::kQuad:
            break;
        case Shape::kBox: {
            int axis = 0;
            normal.cwiseAbs().maxCoeff(&axis);
            face = 2 * axis + (normal[axis] > 0 ? 1 : 0);
            const BoxAxes axes = boxAxes(face);
            a = axes.u_sign * unit[axes.u], b = unit[axes.v];
            break;
        }
        case Shape::kSphere:
            a = std::atan2(unit.y(), unit.x()) / kPi;
            b = std::asin(std::min(1., std::max(-1., unit.z()))) / (0.5 * kPi);
            break;
        case Shape::kCylinder:
            if (normal.x() == 0 && normal.y() == 0) {
                face = normal.z() > 0 ? 2 : 1;
            } else {
                a = std::atan2(unit.y(), unit.x()) / kPi, b = unit.z();
            }
            break;
    }
    FacePoint point = faceExtent(primitive, face);
    point.u = static_cast<float>(a) * point.half_u;
    point.v = static_cast<float>(b) * point.half_v;
    return point;
}

void pointOnFace(const Primitive& primitive, int face, double a, double b, Eigen::Vector3d& unit,
                 Eigen::Vector3d& normal) {
    normal.setZero();
    switch (primitive.shape) {
        case Shape::kQuad:
            unit = {a, b, 0};
            normal.z() = 1;
            break;
        case Shape::kBox: {
            const BoxAxes axes = boxAxes(face);
            const double side = face % 2 ? 1 : -1;
            unit[face / 2] = normal[face / 2] = side;
            unit[axes.u] = axes.u_sign * a;
            unit[axes.v] = b;
            break;
        }
        case Shape::kSphere: {
            const double longitude = kPi * a, latitude = 0.5 * kPi * b;
            unit = {std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude),
                    std::sin(latitude)};
            normal = unit;
            break;
        }
        case Shape::kCylinder: {
            const double k = 0.5 * (primitive.taper - 1), m = 0.5 * (primitive.taper + 1);
            if (face == 0) {
                const double radius = m + k * b, angle = kPi * a;
                unit = {radius * std::cos(angle), radius * std::sin(angle), b};
                normal = {unit.x(), unit.y(), -k * radius};
            } else {
                unit = {a, b, face == 2 ? 1. : -1.};
                normal.z() = unit.z();
            }
            break;
        }
    }
}

}  // namespace roevo::simulator
