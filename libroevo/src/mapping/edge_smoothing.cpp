#include "mapping/edge_smoothing.h"

#include <algorithm>
#include <cmath>

#include "indexing.h"
#include "line_fit.h"

namespace roevo {
namespace {

constexpr int kSpan = 6;         ///< points to each side
constexpr int kLeastPoints = 5;  ///< fewer make no line
constexpr double kSigmas = 3;

}  // namespace

void smoothDepthAlong(std::vector<Eigen::Vector3d>& points, const Pose& T_world_camera,
                      const SensorOptions& sensor) {
    const auto count = static_cast<int>(points.size());
    if (count < kLeastPoints) return;
    const Pose T_camera_world = T_world_camera.inverse();
    std::vector<Eigen::Vector2d> image;  // normalised coordinates
    std::vector<double> inverse;         // of depth: it is linear along the image of a straight edge
    for (const Eigen::Vector3d& point : points) {
        const Eigen::Vector3d q = T_camera_world * point;
        if (!(q.z() > 0)) return;
        image.emplace_back(q.x() / q.z(), q.y() / q.z());
        inverse.push_back(1 / q.z());
    }
    for (int i = 0; i < count; ++i) {
        // A window that does not shrink at the ends
        const int first = std::clamp(i - kSpan, 0, std::max(0, count - 1 - 2 * kSpan));
        const int last = std::min(count - 1, first + 2 * kSpan);
        const auto here = static_cast<std::size_t>(i);
        const Eigen::Vector2d chord = at(image, last) - at(image, first);
        LineFit<double> line;
        for (int j = first; j <= last; ++j) line.add(chord.dot(at(image, j) - image[here]), at(inverse, j));
        if (!(line.spread() > 1e-9 * line.magnitude())) continue;
        const double fitted = line.atZero();
        const double seen = inverse[here];
        const double sigma = sensor.depthSigma(1 / seen) * seen * seen;  // of 1 / z
        if (!(std::abs(fitted - seen) <= kSigmas * sigma) || !(fitted > 0)) continue;
        points[here] = T_world_camera * (Eigen::Vector3d(image[here].x(), image[here].y(), 1) / fitted);
    }
}

}  // namespace roevo
