#include "roevo/camera/pinhole_camera.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace roevo {

bool PinholeCamera::isDistorted() const {
    return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
}

PinholeCamera PinholeCamera::undistorted() const {
    PinholeCamera ideal = *this;
    ideal.distortion.fill(0);
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
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    return {fx * xd + cx, fy * yd + cy};
}

std::string PinholeCamera::check() const {
    std::ostringstream fault;
    if (width < 32 || height < 32 || width > 8192 || height > 8192) {
        fault << "camera: image size " << width << "x" << height << " is outside 32x32 to 8192x8192";
    } else if (!(fx > 0) || !(fy > 0) || !std::isfinite(fx) || !std::isfinite(fy)) {
        fault << "camera: no intrinsics (focal lengths fx = " << fx << ", fy = " << fy
              << " must be positive)";
    } else if (!(cx > 0 && cx < width && cy > 0 && cy < height)) {
        fault << "camera: principal point (" << cx << ", " << cy << ") is outside the " << width << "x"
              << height << " image";
    } else {
        for (const double k : distortion) {
            if (!std::isfinite(k)) fault << "camera: a distortion coefficient is not finite";
        }
    }
    return fault.str();
}

bool PinholeCamera::operator==(const PinholeCamera& other) const {
    return width == other.width && height == other.height && fx == other.fx && fy == other.fy &&
           cx == other.cx && cy == other.cy && distortion == other.distortion;
}

}  // namespace roevo
