#include "intersect.h"

#include <cmath>

namespace roevo::simulator {
namespace {

bool intersectQuad(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double t_min, double t_max,
                   UnitHit& hit) {
    const double t = -o.z() / d.z();
    if (!(t > t_min && t < t_max)) return false;
    if (std::abs(o.x() + t * d.x()) > 1 || std::abs(o.y() + t * d.y()) > 1) return false;
    hit.t = t;
    hit.normal = Eigen::Vector3d(0, 0, 1);
    return true;
}

bool intersectBox(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double t_min, double t_max,
                  UnitHit& hit) {
    double enter = -1e300, leave = 1e300;
    int enter_axis = 0, leave_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double inverse = 1 / d[axis];
        const double near_side = inverse >= 0 ? -1. : 1.;
        const double t0 = (near_side - o[axis]) * inverse, t1 = (-near_side - o[axis]) * inverse;
        if (t0 > enter) enter = t0, enter_axis = axis;
        if (t1 < leave) leave = t1, leave_axis = axis;
    }
    if (enter > leave) return false;
    const bool outside = enter > t_min;
    const double t = outside ? enter : leave;
    if (!(t > t_min && t < t_max)) return false;
    const int axis = outside ? enter_axis : leave_axis;
    hit.t = t;
    hit.normal.setZero();
    hit.normal[axis] = (d[axis] > 0) == outside ? -1 : 1;
    return true;
}

bool intersectSphere(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double t_min, double t_max,
                     UnitHit& hit) {
    const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return false;
    const double root = std::sqrt(discriminant);
    double t = (-b - root) / a;
    if (t <= t_min) t = (-b + root) / a;
    if (!(t > t_min && t < t_max)) return false;
    hit.t = t;
    hit.normal = o + t * d;
    return true;
}

bool intersectCylinder(double taper, const Eigen::Vector3d& o, const Eigen::Vector3d& d, double t_min,
                       double t_max, UnitHit& hit) {
    // Side: x^2 + y^2 = r(z)^2 with r = m + k z.
    const double k = 0.5 * (taper - 1), m = 0.5 * (taper + 1);
    bool found = false;
    double best = t_max;
    const double ro = m + k * o.z(), rd = k * d.z();
    const double a = d.x() * d.x() + d.y() * d.y() - rd * rd;
    const double b = o.x() * d.x() + o.y() * d.y() - ro * rd;
    const double c = o.x() * o.x() + o.y() * o.y() - ro * ro;
    const double discriminant = b * b - a * c;
    if (discriminant >= 0 && std::abs(a) > 1e-14) {
        const double root = std::sqrt(discriminant);
        for (const double t : {(-b - root) / a, (-b + root) / a}) {
            if (!(t > t_min && t < best) || std::abs(o.z() + t * d.z()) > 1) continue;
            best = t;
            found = true;
            const Eigen::Vector3d p = o + t * d;
            hit.normal = Eigen::Vector3d(p.x(), p.y(), -k * (m + k * p.z()));
        }
    }
    for (const double cap : {-1., 1.}) {
        const double t = (cap - o.z()) / d.z();
        const double r = m + k * cap, x = o.x() + t * d.x(), y = o.y() + t * d.y();
        if (!(t > t_min && t < best) || x * x + y * y > r * r) continue;
        best = t;
        found = true;
        hit.normal = Eigen::Vector3d(0, 0, cap);
    }
    hit.t = best;
    return found;
}

}  // namespace

bool intersectUnit(Shape shape, double taper, const Eigen::Vector3d& o, const Eigen::Vector3d& d,
                   double t_min, double t_max, UnitHit& hit) {
    switch (shape) {
        case Shape::kQuad:
            return intersectQuad(o, d, t_min, t_max, hit);
        case Shape::kBox:
            return intersectBox(o, d, t_min, t_max, hit);
        case Shape::kSphere:
            return intersectSphere(o, d, t_min, t_max, hit);
        case Shape::kCylinder:
            return intersectCylinder(taper, o, d, t_min, t_max, hit);
    }
    return false;
}

}  // namespace roevo::simulator
