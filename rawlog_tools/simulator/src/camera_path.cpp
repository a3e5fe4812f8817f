#include "camera_path.h"

#include <algorithm>
#include <cmath>

#include "random.h"
#include "roevo/types.h"

namespace roevo::simulator {
namespace {

constexpr double kTurnRate =
    18 * kPi / 180;                   // rad/s; tremor and the roll that keeps the horizon level come on top
constexpr double kReturnPeriod = 10;  // seconds of one to-and-fro of the path back-and-forth
constexpr int kNodesPerSegment = 16;

/// One component of hand tremor: three incommensurate sinusoids, whose phases come from the seed.
double tremor(double t, unsigned seed, unsigned component) {
    constexpr double kFrequencies[3] = {0.47, 0.93, 1.63}, kWeights[3] = {1, 0.5, 0.18};  // Hz
    double sum = 0;
    for (unsigned i = 0; i < 3; ++i) {
        const double phase = 2 * kPi * uniformOf(hashOf(seed, 1000 + component, i));
        const double frequency = kFrequencies[i] * (0.9 + 0.2 * uniformOf(hashOf(seed, 2000 + component, i)));
        sum += kWeights[i] * std::sin(2 * kPi * frequency * t + phase);
    }
    return sum;
}

}  // namespace

CameraPath::CameraPath(std::vector<Waypoint> loop, PathKind kind, double speed, unsigned seed)
    : loop_(std::move(loop)), kind_(kind), speed_(speed), seed_(seed) {
    const int nodes = static_cast<int>(loop_.size()) * kNodesPerSegment;
    node_times_.assign(1, 0.);
    for (int i = 0; i < nodes; ++i) {
        const double step = 1. / kNodesPerSegment;
        node_times_.push_back(node_times_.back() + timeBetween(i * step, (i + 1) * step));
    }
}

Waypoint CameraPath::at(double u, int derivative) const {
    const int n = static_cast<int>(loop_.size());
    const double whole = std::floor(u), x = u - whole, y = 1 - x;
    const int first = static_cast<int>(std::fmod(whole, n)) + n;
    std::array<double, 4> w{};
    if (derivative == 0) {
        w = {y * y * y / 6, (3 * x * x * x - 6 * x * x + 4) / 6, (3 * y * y * y - 6 * y * y + 4) / 6,
             x * x * x / 6};
    } else {
        w = {-y * y / 2, (3 * x * x - 4 * x) / 2, -(3 * y * y - 4 * y) / 2, x * x / 2};
    }
    Waypoint sum{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int i = 0; i < 4; ++i) {
        const Waypoint& point = loop_[static_cast<size_t>((first + i) % n)];
        sum.position += w[static_cast<size_t>(i)] * point.position;
        sum.target += w[static_cast<size_t>(i)] * point.target;
    }
    return sum;
}

double CameraPath::pace(double u) const {
    const Waypoint value = at(u, 0), slope = at(u, 1);
    const Eigen::Vector3d sight = value.target - value.position;
    const Eigen::Vector3d forward = sight.normalized(), change = slope.target - slope.position;
    const double turn = (change - forward * forward.dot(change)).norm() / sight.norm();
    const double level =
        std::hypot(forward.x(), forward.y());  // turning about the vertical rolls a tilted camera
    const double by_speed = slope.position.norm() / speed_, by_turn = turn / (level * kTurnRate);
    return std::pow(std::pow(by_speed, 4) + std::pow(by_turn, 4), 0.25);
}

double CameraPath::timeBetween(double u0, double u1) const {
    // Gauss-Legendre, five points.
    constexpr double kNodes[5] = {0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                                  0.9061798459386640};
    constexpr double kWeights[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                    0.2369268850561891, 0.2369268850561891};
    double sum = 0;
    for (int i = 0; i < 5; ++i) sum += kWeights[i] * pace(0.5 * (u0 + u1) + 0.5 * (u1 - u0) * kNodes[i]);
    return sum * 0.5 * (u1 - u0);
}

double CameraPath::parameterAt(double seconds) const {
    const double round = node_times_.back();
    const double rounds = std::floor(seconds / round), rest = seconds - rounds * round;
    auto node = static_cast<int>(std::upper_bound(node_times_.begin(), node_times_.end(), rest) -
                                 node_times_.begin()) -
                1;
    node = std::clamp(node, 0, static_cast<int>(node_times_.size()) - 2);
    const double u_node = static_cast<double>(node) / kNodesPerSegment;
    const double t_node = node_times_[static_cast<size_t>(node)];
    double u = u_node;
    for (int i = 0; i < 6; ++i) u -= (t_node + timeBetween(u_node, u) - rest) / pace(u);  // Newton
    return u + rounds * static_cast<double>(loop_.size());
}

double CameraPath::circuitTime() const {
    return kind_ == PathKind::kBackAndForth ? kReturnPeriod : node_times_.back();
}

Pose CameraPath::pose(double seconds) const {
    double along = seconds;
    if (kind_ == PathKind::kBackAndForth) {
        // d(along)/dt never exceeds 1, so the limits of speed hold here as well.
        along = kReturnPeriod / (2 * kPi) * (1 - std::cos(2 * kPi * seconds / kReturnPeriod));
    }
    const Waypoint point = at(parameterAt(along), 0);
    const Eigen::Vector3d forward = (point.target - point.position).normalized();
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d axes;
    axes << right, forward.cross(right), forward;

    constexpr double kShift = 0.004, kTilt = 0.35 * kPi / 180;
    Eigen::Vector3d shift, tilt;
    for (unsigned i = 0; i < 3; ++i) {
        shift[i] = kShift * tremor(seconds, seed_, i);
        tilt[i] = kTilt * tremor(seconds, seed_, 3 + i);
    }
    return {Eigen::Quaterniond(axes) * Eigen::AngleAxisd(tilt.norm(), tilt.normalized()),
            point.position + shift};
}

}  // namespace roevo::simulator
