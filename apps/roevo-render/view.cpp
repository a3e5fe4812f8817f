#include "view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roevo {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kDegrees = 1 / kRadians;
// A stray lies farther from the middle than the nine tenths nearest to it, with a gap before it
constexpr double kNeverStray = 0.9;
constexpr float kFartherBy = 1.5f;  // farther by this factor than the next nearer point
constexpr double kFilled = 0.94;    // share of the picture that the content fills
constexpr double kFov = 40, kParallelFov = 1, kFollowFov = 55;  // deg; from far off, rays are parallel
constexpr double kIsoElevation = 38;                            // deg

// The value below which `share` of the values lies; reorders them.
double lowQuantile(std::vector<double>& values, double share) {
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
}

// Smallest value of normal . p over all.
double support(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& normal) {
    const Eigen::Vector3f n = normal.cast<float>();
    float lowest = std::numeric_limits<float>::infinity();
    for (const auto& p : points) lowest = std::min(lowest, n.dot(p));
    return lowest;
}

// All that must be shown: strays are wrong depths, and what is seen through a window.
std::vector<Eigen::Vector3f> withoutStrays(const ViewContent& content) {
    const auto& cloud = content.cloud;
    std::vector<Eigen::Vector3f> kept = content.must_see;
    if (cloud.empty() && kept.empty())
        throw std::runtime_error("the scene has nothing in it that could be shown");
    if (cloud.empty()) return kept;
    Eigen::Vector3f middle;
    std::vector<double> values(cloud.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = cloud[i][axis];
        middle[axis] = static_cast<float>(lowQuantile(values, 0.5));
    }
    for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = (cloud[i] - middle).norm();
    std::sort(values.begin(), values.end());
    auto last =
        values.begin() + static_cast<std::ptrdiff_t>(kNeverStray * static_cast<double>(values.size() - 1));
    while (last + 1 != values.end() && last[1] <= kFartherBy * last[0]) ++last;
    for (const auto& p : cloud)
        if ((p - middle).norm() <= *last) kept.push_back(p);
    return kept;
}

Eigen::Matrix3d lookingAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& up) {
    Eigen::Matrix3d R;
    R.col(2) = direction.normalized();
    R.col(0) = R.col(2).cross(up).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return R;
}

// From the raised corner that `azimuth_deg` is the direction from.
Eigen::Vector3d downwards(double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * kRadians, e = elevation_deg * kRadians;
    return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), -std::sin(e)};
}

// Looks along z of R, from `distance` before the point that is to be in the middle.
View viewOf(const Eigen::Matrix3d& R, const Eigen::Vector3d& middle, double distance, double fov_deg) {
    View view;
    view.vertical_fov_deg = fov_deg;
    view.distance = distance;
    view.parallel = fov_deg <= kParallelFov;
    view.near = 0.02 * distance;
    view.far = 50 * distance;
    view.T_scene_camera.linear() = R;
    view.T_scene_camera.translation() = middle - distance * R.col(2);
    return view;
}

}  // namespace

double View::pixelsPerMetre(int height) const {
    return height / (2 * distance * std::tan(vertical_fov_deg / 2 * kRadians));
}

Eigen::AlignedBox3f boundsOf(const ViewContent& content) {
    Eigen::AlignedBox3f box;
    for (const auto& p : withoutStrays(content)) box.extend(p);
    return box;
}

View frameContent(const ViewContent& all, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                  double aspect, double vertical_fov_deg) {
    const auto content = withoutStrays(all);
    const Eigen::Matrix3d R = lookingAlong(direction, up);
    const double tan_v = std::tan(vertical_fov_deg / 2 * kRadians) * kFilled, tan_h = tan_v * aspect;

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
    const double nearest = support(content, R.col(2)), farthest = -support(content, -R.col(2));
    c.z() = std::min({from_width, from_height, nearest - 1e-3 * std::max(farthest - nearest, 1.)});

    const double distance = (nearest + farthest) / 2 - c.z();
    View view = viewOf(R, R * (c + Eigen::Vector3d(0, 0, distance)), distance, vertical_fov_deg);
    view.near = std::max(0.1 * (nearest - c.z()), 1e-3 * distance);
    return view;
}

View fixedView(const std::string& name, const ViewContent& content, double aspect) {
    const Eigen::Vector3d z_up = Eigen::Vector3d::UnitZ();
    if (name == "top") return frameContent(content, -z_up, Eigen::Vector3d::UnitX(), aspect, kParallelFov);
    if (name == "front") return frameContent(content, downwards(0, 5), z_up, aspect, kFov);
    if (name == "iso") return frameContent(content, downwards(35, kIsoElevation), z_up, aspect, kFov);
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
    view.vertical_fov_deg = kFollowFov;
    view.distance = 1.6 * distance;
    view.near = 0.01 * distance;
    view.far = 100 * distance;
    view.T_scene_camera = T_scene_camera * Eigen::Translation3d(0, -0.25 * distance, -0.6 * distance) *
                          Eigen::AngleAxisd(-12 * kRadians, Eigen::Vector3d::UnitX());
    return view;
}

View lookAt(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d direction = (to - from).normalized(), z_up = Eigen::Vector3d::UnitZ();
    const bool is_vertical = direction.cross(z_up).norm() < 1e-6;
    const Eigen::Vector3d up = is_vertical ? Eigen::Vector3d::UnitX() : z_up;
    return viewOf(lookingAlong(direction, up), to, (to - from).norm(), kFov);
}

View orbitView(const ViewContent& all, double aspect) {
    const auto content = withoutStrays(all);
    const Eigen::AlignedBox3f box = boundsOf(all);
    const double tan_v = std::tan(kFov / 2 * kRadians) * kFilled, tan_h = tan_v * aspect;
    const auto lookingFrom = [](double azimuth_deg) {
        return lookingAlong(downwards(azimuth_deg, kIsoElevation), Eigen::Vector3d::UnitZ());
    };
    float distance = 0.1f;
    for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 10) {
        const Eigen::Matrix3f R = lookingFrom(azimuth_deg).cast<float>();
        const auto x = static_cast<float>(1 / tan_h), y = static_cast<float>(1 / tan_v);
        for (const auto& p : content) {
            const Eigen::Vector3f q = R.transpose() * (p - box.center());
            distance = std::max(distance, std::max(x * std::abs(q.x()), y * std::abs(q.y())) - q.z());
        }
    }
    return viewOf(lookingFrom(35), box.center().cast<double>(), distance, kFov);
}

View turned(const View& view, double angle) {
    const Eigen::Vector3d middle = view.T_scene_camera * Eigen::Vector3d(0, 0, view.distance);
    View turned = view;
    turned.T_scene_camera = Eigen::Translation3d(middle) *
                            Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                            Eigen::Translation3d(-middle) * view.T_scene_camera;
    return turned;
}

View zoomed(View view, double factor) {
    view.vertical_fov_deg = 2 * std::atan(std::tan(view.vertical_fov_deg / 2 * kRadians) / factor) * kDegrees;
    return view;
}

}  // namespace roevo
