#include "view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roevo {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kOutliers = 0.001;  // share of the cloud that each side of the picture may cut off
constexpr float kReach =
    1.6f;  // points farther from the middle than this times the 90 % distance do not count
constexpr double kMargin = 0.94;  // share of the picture that the content fills

// The value below which `share` of the values lies; reorders them.
double lowQuantile(std::vector<double>& values, double share) {
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
}

// Smallest value of normal . p: over all of must_see, over all but the outliers of the cloud.
double support(const ViewContent& content, const Eigen::Vector3d& normal) {
    const Eigen::Vector3f n = normal.cast<float>();
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& p : content.must_see) lowest = std::min(lowest, static_cast<double>(n.dot(p)));
    if (content.cloud.empty()) return lowest;
    std::vector<double> values;
    values.reserve(content.cloud.size());
    for (const auto& p : content.cloud) values.push_back(n.dot(p));
    return std::min(lowest, lowQuantile(values, kOutliers));
}

// The cloud without the points that lie far off: wrong depths, and what is seen through a window.
std::vector<Eigen::Vector3f> withoutOutliers(const std::vector<Eigen::Vector3f>& cloud) {
    if (cloud.empty()) return {};
    Eigen::Vector3f middle;
    std::vector<double> values(cloud.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = cloud[i][axis];
        middle[axis] = static_cast<float>(lowQuantile(values, 0.5));
    }
    for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = (cloud[i] - middle).norm();
    const float reach = kReach * static_cast<float>(lowQuantile(values, 0.9));
    std::vector<Eigen::Vector3f> kept;
    for (const auto& p : cloud)
        if ((p - middle).norm() <= reach) kept.push_back(p);
    return kept;
}

Eigen::Matrix3d lookingAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& up) {
    Eigen::Matrix3d R;
    R.col(2) = direction.normalized();
    R.col(0) = R.col(2).cross(up).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return R;
}

}  // namespace

View frameContent(const ViewContent& all, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                  double aspect) {
    const ViewContent content{withoutOutliers(all.cloud), all.must_see};
    if (content.cloud.empty() && content.must_see.empty())
        throw std::runtime_error("the scene has nothing in it that could be shown");
    View view;
    const Eigen::Matrix3d R = lookingAlong(direction, up);
    const double tan_v = std::tan(view.vertical_fov_deg / 2 * kRadians) * kMargin, tan_h = tan_v * aspect;

    // A point is inside the picture's left border when x + z tan >= cx + cz tan, with (cx, cy, cz) the camera
    // in the axes R; likewise on the other sides. Two opposite borders that touch the content give cx and cz.
    const auto touch = [&](int axis, double tangent, double& centre) {
        const Eigen::Vector3d side = R.col(axis), forward = R.col(2) * tangent;
        const double a = support(content, side + forward), b = -support(content, -side + forward);
        centre = (a + b) / 2;
        return (a - b) / (2 * tangent);
    };
    Eigen::Vector3d c;
    const double from_width = touch(0, tan_h, c.x()), from_height = touch(1, tan_v, c.y());
    c.z() = std::min(from_width, from_height);

    const double nearest = support(content, R.col(2)) - c.z(),
                 farthest = -support(content, -R.col(2)) - c.z();
    const double extent = std::max(farthest, 1e-3);
    view.near = std::max(0.1 * nearest, 1e-3 * extent);
    view.far = 20 * extent;
    view.T_scene_camera.linear() = R;
    view.T_scene_camera.translation() = R * c;
    return view;
}

View fixedView(const std::string& name, const ViewContent& content, double aspect) {
    const auto direction = [](double azimuth_deg, double elevation_deg) {
        const double a = azimuth_deg * kRadians, e = elevation_deg * kRadians;
        return Eigen::Vector3d(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), -std::sin(e));
    };
    const Eigen::Vector3d z_up = Eigen::Vector3d::UnitZ();
    if (name == "top") return frameContent(content, -z_up, Eigen::Vector3d::UnitX(), aspect);
    if (name == "front") return frameContent(content, direction(0, 5), z_up, aspect);
    if (name == "iso") return frameContent(content, direction(35, 38), z_up, aspect);
    throw std::invalid_argument("unknown view '" + name + "'");
}

View followView(const Eigen::Isometry3d& T_scene_camera, const ViewContent& content) {
    // How far the content is decides how far behind the camera we stand.
    std::vector<double> depths;
    for (const auto& p : content.cloud) {
        const Eigen::Vector3d q = T_scene_camera.inverse() * p.cast<double>();
        if (q.z() > 0 && std::abs(q.x()) < q.z() && std::abs(q.y()) < q.z()) depths.push_back(q.z());
    }
    const double distance = depths.empty() ? 2 : lowQuantile(depths, 0.5);
    View view;
    view.vertical_fov_deg = 55;
    view.near = 0.01 * distance;
    view.far = 100 * distance;
    view.T_scene_camera = T_scene_camera * Eigen::Translation3d(0, -0.25 * distance, -0.6 * distance) *
                          Eigen::AngleAxisd(-12 * kRadians, Eigen::Vector3d::UnitX());
    return view;
}

}  // namespace roevo
