#include "tubes.h"

#include <Eigen/Geometry>
#include <cmath>

namespace roevo {
namespace {

constexpr int kSides = 6;

mrpt::math::TPoint3Df point(const Eigen::Vector3f& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace

void appendTube(compat::scene::CSetOfTriangles& out, const std::vector<Eigen::Vector3f>& polyline,
                float radius, const mrpt::img::TColor& colour) {
    const auto add = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                         const Eigen::Vector3f& na, const Eigen::Vector3f& nb, const Eigen::Vector3f& nc) {
        compat::scene::TTriangle triangle(point(a), point(b), point(c), point(na), point(nb), point(nc));
        triangle.setColor(colour);
        out.insertTriangle(triangle);
    };
    for (std::size_t i = 1; i < polyline.size(); i++) {
        const Eigen::Vector3f from = polyline[i - 1], to = polyline[i], along = to - from;
        if (along.norm() < 1e-6f) continue;
        const Eigen::Vector3f side = along.unitOrthogonal(), up = along.normalized().cross(side);
        for (int k = 0; k < kSides; k++) {
            const auto normal = [&](int corner) -> Eigen::Vector3f {
                const float angle = static_cast<float>(2 * M_PI * corner / kSides);
                return std::cos(angle) * side + std::sin(angle) * up;
            };
            const Eigen::Vector3f n0 = normal(k), n1 = normal(k + 1), r0 = radius * n0, r1 = radius * n1;
            add(from + r0, from + r1, to + r1, n0, n1, n1);
            add(from + r0, to + r1, to + r0, n0, n1, n0);
        }
    }
}

}  // namespace roevo
