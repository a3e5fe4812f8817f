#include "roevo/camera/pinhole_camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace roevo {

namespace {

/// Angle on the image of a fish-eye, in focal lengths, for an angle to the axis.
double fisheyeAngle(const std::array<double, 5>& k, double theta) {
    const double t2 = theta * theta;
    return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double fisheyeSlope(const std::array<double, 5>& k, double theta) {
    const double t2 = theta * theta;
    return 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
}

/// 1 + k1 r2 + k2 r2^2 + k3 r2^3 and its derivative by r2.
struct Cubic {
    double value, slope;
    Cubic(double k1, double k2, double k3, double r2)
        : value(1 + r2 * (k1 + r2 * (k2 + r2 * k3))), slope(k1 + r2 * (2 * k2 + r2 * 3 * k3)) {}
};

/// Pixels: corners, middles of borders, and the middle.
std::array<Eigen::Vector2d, 9> spreadOver(const PinholeCamera& camera) {
    std::array<Eigen::Vector2d, 9> pixels;
    auto next = pixels.begin();
    for (const double u : {0.0, 0.5 * camera.width, camera.width - 1.0})
        for (const double v : {0.0, 0.5 * camera.height, camera.height - 1.0}) *next++ = {u, v};
    return pixels;
}

/// How far the lens moves a ray near the image's border, as a share of its distance from the axis. Terms
/// hold where they were calibrated: up to there at most. A fish-eye may move rays by any amount.
double farthestMoved(const PinholeCamera& camera) {
    constexpr double kCalibrated = 0.5;  // focal lengths from the axis
    double farthest = 0;
    if (camera.lens == LensModel::kKannalaBrandt) return farthest;
    const Eigen::Vector2d centre(camera.cx, camera.cy);
    for (const Eigen::Vector2d& pixel : spreadOver(camera)) {
        const double distance = (pixel - centre).norm();
        if (distance < 1) continue;  // px
        const Eigen::Vector2d ray = (pixel - centre) * std::min(1.0, kCalibrated * camera.fx / distance);
        const double moved = (camera.distortPixel(centre + ray) - centre - ray).norm() / ray.norm();
        if (!std::isfinite(moved)) return moved;
        farthest = std::max(farthest, moved);
    }
    return farthest;
}

}  // namespace

bool PinholeCamera::isDistorted() const {
    return distortion != std::array<double, 5>{} || lens == LensModel::kKannalaBrandt || isRational();
}

PinholeCamera PinholeCamera::undistorted() const {
    PinholeCamera ideal = *this;
    ideal.distortion.fill(0);
    ideal.denominator.fill(0);
    ideal.lens = LensModel::kBrownConrady;
    return ideal;
}

PinholeCamera PinholeCamera::atPyramidLevel(int level) const {
    PinholeCamera scaled = *this;
    const double scale = 1.0 / (1 << level);
    scaled.width = width >> level;
    scaled.height = height >> level;
    scaled.fx = fx * scale;
    scaled.fy = fy * scale;
    scaled.cx = (cx + 0.5) * scale - 0.5;
    scaled.cy = (cy + 0.5) * scale - 0.5;
    return scaled;
}

Eigen::Vector2d PinholeCamera::distortPixel(const Eigen::Vector2d& ideal) const {
    if (!isDistorted()) return ideal;
    const auto& [k1, k2, p1, p2, k3] = distortion;
    const double x = (ideal.x() - cx) / fx, y = (ideal.y() - cy) / fy;
    const double r2 = x * x + y * y;
    if (lens == LensModel::kKannalaBrandt) {
        const double r = std::sqrt(r2);
        const double scale = r > 0 ? fisheyeAngle(distortion, std::atan(r)) / r : 1;
        return {fx * scale * x + cx, fy * scale * y + cy};
    }
    const auto& [k4, k5, k6] = denominator;
    const double radial = Cubic(k1, k2, k3, r2).value / Cubic(k4, k5, k6, r2).value;
    const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    return {fx * xd + cx, fy * yd + cy};
}

Eigen::Vector2d PinholeCamera::undistortPixel(const Eigen::Vector2d& real) const {
    if (!isDistorted()) return real;
    constexpr int kSteps = 20;
    if (lens == LensModel::kKannalaBrandt) {
        const Eigen::Vector2d seen((real.x() - cx) / fx, (real.y() - cy) / fy);
        const double angle = seen.norm();
        if (angle == 0) return real;
        double theta = angle;
        for (int i = 0; i < kSteps; ++i)
            theta -= (fisheyeAngle(distortion, theta) - angle) / fisheyeSlope(distortion, theta);
        // At a right angle and beyond there is no such pixel
        const double scale = theta < M_PI_2 ? std::tan(theta) / angle : std::nan("");
        return {fx * scale * seen.x() + cx, fy * scale * seen.y() + cy};
    }
    Eigen::Vector2d ideal = real;
    for (int i = 0; i < kSteps; ++i) ideal += real - distortPixel(ideal);
    if (!isRational()) return ideal;
    // Such lenses reach so far out that the fixed point is slow to come
    for (int i = 0; i < kSteps; ++i) {
        Eigen::Matrix2d J;
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Vector2d step = 1e-3 * Eigen::Vector2d::Unit(axis);
            J.col(axis) = (distortPixel(ideal + step) - distortPixel(ideal - step)) / 2e-3;
        }
        ideal += J.inverse() * (real - distortPixel(ideal));
    }
    return ideal;
}

double PinholeCamera::unfoldedRadiusSquared() const {
    constexpr double kStep = 0.01, kFarthest = 100;
    const auto unfolded = [&](double r2) {
        const auto& [k1, k2, p1, p2, k3] = distortion;
        const auto& [k4, k5, k6] = denominator;
        if (lens == LensModel::kKannalaBrandt) return fisheyeSlope(distortion, std::atan(std::sqrt(r2))) > 0;
        const Cubic above(k1, k2, k3, r2), below(k4, k5, k6, r2);
        return below.value > 0 &&
               above.value * below.value + 2 * r2 * (above.slope * below.value - above.value * below.slope) >
                   0;
    };
    double r2 = 0;
    while (r2 < kFarthest && unfolded(r2)) r2 += kStep;
    return r2;
}

std::string PinholeCamera::check() const {
    // From a view of 170 degrees to one of a telescope. Sizes in pixels follow from the focal length
    constexpr double kShortest = 0.05, kLongest = 1000;  // times the image's width
    constexpr double kMostMoved = 0.5;
    std::ostringstream fault;
    if (width < 32 || height < 32 || width > 8192 || height > 8192) {
        fault << "camera: image size " << width << "x" << height << " is outside 32x32 to 8192x8192";
    } else if (!(fx > 0) || !(fy > 0) || !std::isfinite(fx) || !std::isfinite(fy)) {
        fault << "camera: no intrinsics (focal lengths fx = " << fx << ", fy = " << fy
              << " must be positive)";
    } else if (std::min(fx, fy) < kShortest * width || std::max(fx, fy) > kLongest * width) {
        fault << "camera: focal lengths fx = " << fx << ", fy = " << fy << " are outside " << kShortest
              << " to " << kLongest << " times the image's width of " << width << " px";
    } else if (!(cx > 0 && cx < width && cy > 0 && cy < height)) {
        fault << "camera: principal point (" << cx << ", " << cy << ") is outside the " << width << "x"
              << height << " image";
    } else {
        const auto finite = [](double k) { return std::isfinite(k); };
        if (!std::all_of(distortion.begin(), distortion.end(), finite) ||
            !std::all_of(denominator.begin(), denominator.end(), finite))
            fault << "camera: a distortion coefficient is not finite";
        else if (const double moved = farthestMoved(*this); !(moved <= kMostMoved))
            fault << "camera: the lens moves the image by " << std::lround(moved < 1e4 ? 100 * moved : 1e6)
                  << " % of the distance from its centre: are its terms in the order k1 k2 p1 p2 k3?";
    }
    return fault.str();
}

bool PinholeCamera::seesAs(const PinholeCamera& other) const {
    constexpr double kSame = 0.01;  // px
    if (*this == other) return true;
    if (width != other.width || height != other.height || lens != other.lens) return false;
    for (const Eigen::Vector2d& pixel : spreadOver(*this)) {
        const Eigen::Vector2d here = distortPixel(pixel);
        const Eigen::Vector2d there = other.distortPixel(other.project(backProject(pixel.x(), pixel.y(), 1)));
        if (!((here - there).norm() <= kSame)) return false;
    }
    return true;
}

bool PinholeCamera::operator==(const PinholeCamera& other) const {
    return width == other.width && height == other.height && fx == other.fx && fy == other.fy &&
           cx == other.cx && cy == other.cy && distortion == other.distortion &&
           denominator == other.denominator && lens == other.lens;
}

}  // namespace roevo
