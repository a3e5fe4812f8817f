#pragma once
#include <Eigen/Core>
#include <array>
#include <string>

namespace roevo {

/// Pinhole camera with the Brown-Conrady lens of OpenCV and MRPT. Pixel centres are at integer coordinates.
/// Camera frame: x right, y down, z forward, metres.
struct PinholeCamera {
    int width = 0, height = 0;              ///< pixels
    double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
    std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3, dimensionless

    bool isDistorted() const;

    /// The same camera with an ideal lens.
    PinholeCamera undistorted() const;

    /// Camera of pyramid level `level`, each level averaging 2x2 pixels of the one below. Because pixel
    /// centres are at integers, cx' = (cx + 0.5) / 2^level - 0.5; width and height are halved and floored.
    PinholeCamera atPyramidLevel(int level) const;

    /// Pixels of this camera that see what one pixel of a 640x480 Kinect does (f = 525 px): what is given in
    /// pixels is meant for that one.
    double pixelScale() const { return fx / 525; }

    /// Ideal projection of a camera-frame point (z > 0), metres to pixels; distortion is not applied.
    Eigen::Vector2d project(const Eigen::Vector3d& point) const {
        return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
    }

    /// Inverse of project() for a depth along the optical axis, metres.
    Eigen::Vector3d backProject(double u, double v, double depth) const {
        return {(u - cx) / fx * depth, (v - cy) / fy * depth, depth};
    }

    /// Where the real lens puts an ideally projected pixel; without distortion the pixel itself.
    Eigen::Vector2d distortPixel(const Eigen::Vector2d& ideal) const;

    /// Empty when usable, else one line naming what is wrong and its value.
    std::string check() const;

    bool operator==(const PinholeCamera& other) const;
    bool operator!=(const PinholeCamera& other) const { return !(*this == other); }
};

}  // namespace roevo
