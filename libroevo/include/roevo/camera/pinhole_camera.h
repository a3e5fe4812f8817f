#pragma once
#include <Eigen/Core>
#include <array>
#include <string>

namespace roevo {

/// What the terms of a lens mean, as in OpenCV, ROS and MRPT.
enum class LensModel {
    kBrownConrady,   ///< radial and tangential: "plumb_bob", with k4 k5 k6 "rational_polynomial"
    kKannalaBrandt,  ///< a fish-eye: "equidistant", where the angle to the axis counts and not its tangent
};

/// Pinhole camera with a lens. Pixel centres are at integer coordinates.
/// Camera frame: x right, y down, z forward, metres.
struct PinholeCamera {
    int width = 0, height = 0;              ///< pixels
    double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
    std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3, dimensionless; of a fish-eye k1 k2 k3 k4 0
    std::array<double, 3>
        denominator{};  ///< k4 k5 k6 of a rational model, which the radial part is divided by
    LensModel lens = LensModel::kBrownConrady;

    bool isDistorted() const;

    bool isRational() const { return denominator != std::array<double, 3>{}; }

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

    /// The ideal pixel that distortPixel() puts there, as far as the lens does not fold its image; else
    /// anything, even no number.
    Eigen::Vector2d undistortPixel(const Eigen::Vector2d& real) const;

    /// Square of the normalised radius (tangent of the angle to the axis) up to which the lens maps outward
    /// points farther out, at most 100. Beyond, its polynomial folds back into the image.
    double unfoldedRadiusSquared() const;

    /// Empty when usable, else one line naming what is wrong and its value.
    std::string check() const;

    /// Whether both see every point in the same place, within 0.01 px: what is written with fewer digits is
    /// no other camera.
    bool seesAs(const PinholeCamera& other) const;

    bool operator==(const PinholeCamera& other) const;
    bool operator!=(const PinholeCamera& other) const { return !(*this == other); }
};

}  // namespace roevo
