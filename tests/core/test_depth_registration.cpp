// Depth registered to the colour camera: identity, moved cameras, z-buffer, holes; ranges to depths.
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "roevo/camera/depth_registration.h"

namespace roevo {
namespace {

const PinholeCamera kDepthCamera{160, 120, 130, 132, 79.2, 60.4, {}};

/// Depth at pixel (u, v) of the plane n . p = d.
double planeDepth(const PinholeCamera& camera, const Eigen::Vector3d& n, double d, double u, double v) {
    return d / n.dot(camera.backProject(u, v, 1));
}

cv::Mat planeImage(const PinholeCamera& camera, const Eigen::Vector3d& n, double d) {
    cv::Mat depth(camera.height, camera.width, CV_32FC1);
    for (int v = 0; v < depth.rows; ++v) {
        for (int u = 0; u < depth.cols; ++u) {
            depth.at<float>(v, u) = static_cast<float>(planeDepth(camera, n, d, u, v));
        }
    }
    return depth;
}

Pose moved(double x, double y, double z) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(x, y, z);
    return pose;
}

TEST(RegisterDepth, SameCameraGivesTheSameImageHolesIncluded) {
    cv::Mat depth = planeImage(kDepthCamera, {0.2, -0.1, 1}, 2);
    depth.at<float>(30, 40) = 0;
    depth.at<float>(31, 40) = std::numeric_limits<float>::quiet_NaN();
    depth.at<float>(32, 40) = std::numeric_limits<float>::infinity();
    depth.at<float>(33, 40) = -1;
    const cv::Mat registered = registerDepth(depth, kDepthCamera, kDepthCamera, Pose::Identity());
    for (int v = 30; v < 34; ++v) depth.at<float>(v, 40) = 0;
    EXPECT_EQ(cv::norm(registered, depth, cv::NORM_INF), 0);
}

TEST(RegisterDepth, SideStepMovesAFrontalPlaneByItsDisparity) {
    cv::Mat depth = cv::Mat::zeros(120, 160, CV_32FC1);
    depth(cv::Rect(60, 40, 20, 30)).setTo(2.0F);
    // 10 px of disparity at 2 m
    const Pose T_colour_depth = moved(10 * 2.0 / kDepthCamera.fx, 0, 0);
    const cv::Mat registered = registerDepth(depth, kDepthCamera, kDepthCamera, T_colour_depth);
    cv::Mat expected = cv::Mat::zeros(120, 160, CV_32FC1);
    expected(cv::Rect(70, 40, 20, 30)).setTo(2.0F);
    EXPECT_EQ(cv::norm(registered, expected, cv::NORM_INF), 0);
}

TEST(RegisterDepth, NearestWins) {
    // Two spots that fall on one pixel of the colour camera: 1 m and 2 m, whichever comes first in the image
    for (const bool near_first : {true, false}) {
        cv::Mat depth = cv::Mat::zeros(120, 160, CV_32FC1);
        const double step = (near_first ? 1 : -1) * 20 / kDepthCamera.fx;  // 20 px at 1 m, 10 px at 2 m
        const int sign = near_first ? 1 : -1;
        depth.at<float>(60, 80 - 20 * sign) = 1;
        depth.at<float>(60, 80 - 10 * sign) = 2;
        const cv::Mat registered = registerDepth(depth, kDepthCamera, kDepthCamera, moved(step, 0, 0));
        EXPECT_FLOAT_EQ(registered.at<float>(60, 80), 1);
        EXPECT_EQ(cv::countNonZero(registered), 1);
    }
}

TEST(RegisterDepth, ADifferentCameraSeesTheSamePlane) {
    const PinholeCamera colour{200, 150, 150, 151, 99, 74, {}};
    Pose T_colour_depth = moved(0.05, -0.01, 0.002);
    T_colour_depth.setRotation(
        Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 0.5).normalized()).toRotationMatrix());
    const Eigen::Vector3d n(0.1, 0.05, 1);
    const cv::Mat registered =
        registerDepth(planeImage(kDepthCamera, n, 2), kDepthCamera, colour, T_colour_depth);
    // The plane in the colour camera: n' = R n, d' = d + n' . t
    const Eigen::Vector3d n2 = T_colour_depth.linear() * n;
    const double d2 = 2 + n2.dot(T_colour_depth.translation());
    int holes = 0;
    for (int v = 15; v < 135; ++v) {
        for (int u = 25; u < 180; ++u) {
            const double z = registered.at<float>(v, u);
            if (z == 0) {
                ++holes;
                continue;
            }
            const double slope =
                std::abs(planeDepth(colour, n2, d2, u + 1, v) - planeDepth(colour, n2, d2, u, v)) +
                std::abs(planeDepth(colour, n2, d2, u, v + 1) - planeDepth(colour, n2, d2, u, v));
            EXPECT_NEAR(z, planeDepth(colour, n2, d2, u, v), slope) << u << "," << v;
        }
    }
    EXPECT_EQ(holes, 0) << "a finer colour camera must not leave holes in a plane";
}

TEST(RegisterDepth, APixelCoversAsMuchAsItDoesInTheColourCamera) {
    for (const int scale : {1, 2, 3, 5}) {
        const PinholeCamera colour{160 * scale,
                                   120 * scale,
                                   kDepthCamera.fx * scale,
                                   kDepthCamera.fy * scale,
                                   (kDepthCamera.cx + 0.5) * scale - 0.5,
                                   (kDepthCamera.cy + 0.5) * scale - 0.5,
                                   {}};
        cv::Mat depth = cv::Mat::zeros(120, 160, CV_32FC1);
        depth.at<float>(50, 70) = 2;
        const cv::Mat registered = registerDepth(depth, kDepthCamera, colour, Pose::Identity());
        const cv::Rect box = cv::boundingRect(registered > 0);
        EXPECT_EQ(cv::countNonZero(registered), box.area()) << scale;
        EXPECT_NEAR(box.width, scale, 1) << scale;
        EXPECT_NEAR(box.height, scale, 1) << scale;
        EXPECT_NEAR(box.x + (box.width - 1) / 2.0, 70.5 * scale - 0.5, 0.51) << scale;
        EXPECT_NEAR(box.y + (box.height - 1) / 2.0, 50.5 * scale - 0.5, 0.51) << scale;
    }
}

TEST(RegisterDepth, WhatALensThatFoldsCannotSeeIsNotPaintedIntoItsMiddle) {
    const PinholeCamera colour{640, 480, 300, 300, 319.5, 239.5, {-0.4, 0, 0, 0, 0}},
        wide{640, 480, 100, 100, 319.5, 239.5, {}};
    cv::Mat outside = cv::Mat::zeros(480, 640, CV_32FC1), inside = outside.clone();
    const cv::Rect middle(160, 120, 320, 240);
    int folded = 0;
    for (int v = 0; v < 480; ++v) {
        for (int u = 0; u < 640; ++u) {
            const Eigen::Vector3d ray = wide.backProject(u, v, 1);
            const double radius = ray.head<2>().norm();
            if (radius < 0.9) inside.at<float>(v, u) = 2;
            if (radius <= 1.3) continue;
            outside.at<float>(v, u) = 2;
            const Eigen::Vector2d pixel = colour.distortPixel(colour.project(ray));
            if (middle.contains(cv::Point(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()))))
                ++folded;
        }
    }
    ASSERT_GT(folded, 1000) << "the polynomial must put them there";
    EXPECT_EQ(cv::countNonZero(registerDepth(outside, wide, colour, Pose::Identity())(middle)), 0);
    EXPECT_GT(cv::countNonZero(registerDepth(inside, wide, colour, Pose::Identity())(middle)), 70000);
}

TEST(RegisterDepth, TheColourLensMovesPixels) {
    PinholeCamera colour = kDepthCamera;
    colour.distortion = {0.2, 0, 0, 0, 0};
    cv::Mat depth = cv::Mat::zeros(120, 160, CV_32FC1);
    depth.at<float>(20, 20) = 1.5F;
    const cv::Mat registered = registerDepth(depth, kDepthCamera, colour, Pose::Identity());
    const Eigen::Vector2d where = colour.distortPixel({20, 20});
    EXPECT_GT((where - Eigen::Vector2d(20, 20)).norm(), 2);
    EXPECT_FLOAT_EQ(registered.at<float>(static_cast<int>(std::lround(where.y())),
                                         static_cast<int>(std::lround(where.x()))),
                    1.5F);
    // and back: a distorted depth camera is undone
    const cv::Mat back = registerDepth(registered, colour, kDepthCamera, Pose::Identity());
    cv::Point peak;
    cv::minMaxLoc(back, nullptr, nullptr, nullptr, &peak);
    EXPECT_LE(std::abs(peak.x - 20) + std::abs(peak.y - 20), 1);
}

TEST(RegisterDepth, PointsBehindTheColourCameraVanish) {
    const cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(1.0F));
    EXPECT_EQ(cv::countNonZero(registerDepth(depth, kDepthCamera, kDepthCamera, moved(0, 0, -2))), 0);
}

TEST(RegisterDepth, RefusesAnImageOfAnotherSizeOrType) {
    EXPECT_THROW(registerDepth(cv::Mat(10, 10, CV_32FC1), kDepthCamera, kDepthCamera, Pose::Identity()),
                 std::invalid_argument);
    EXPECT_THROW(registerDepth(cv::Mat(120, 160, CV_16UC1), kDepthCamera, kDepthCamera, Pose::Identity()),
                 std::invalid_argument);
}

TEST(RegisterDepth, RefusesACameraOrAPoseThatIsNone) {
    const cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(1.0F));
    PinholeCamera blind = kDepthCamera;
    blind.fx = 0;
    const Pose here = Pose::Identity();
    EXPECT_THROW(registerDepth(depth, blind, kDepthCamera, here), std::invalid_argument);
    EXPECT_THROW(registerDepth(depth, kDepthCamera, blind, here), std::invalid_argument);
    EXPECT_THROW(registerDepth(depth, kDepthCamera, PinholeCamera(), here), std::invalid_argument);
    EXPECT_THROW(registerDepth(depth, kDepthCamera, kDepthCamera, moved(0, NAN, 0)), std::invalid_argument);
    cv::Mat range = depth.clone();
    EXPECT_THROW(rangeToDepth(range, blind), std::invalid_argument);
    const PinholeCamera few{8, 8, 8, 8, 3.5, 3.5, {}};
    EXPECT_NO_THROW(registerDepth(cv::Mat(8, 8, CV_32FC1, cv::Scalar(1.0F)), few, kDepthCamera, here));
}

TEST(RangeToDepth, RangesToAPlaneBecomeItsDepth) {
    const Eigen::Vector3d n(0.1, -0.2, 1);
    const cv::Mat depth = planeImage(kDepthCamera, n, 1.5);
    cv::Mat range = depth.clone();
    for (int v = 0; v < range.rows; ++v) {
        for (int u = 0; u < range.cols; ++u) {
            range.at<float>(v, u) = static_cast<float>(
                kDepthCamera.backProject(u, v, static_cast<double>(depth.at<float>(v, u))).norm());
        }
    }
    range.at<float>(5, 5) = 0;
    rangeToDepth(range, kDepthCamera);
    EXPECT_EQ(range.at<float>(5, 5), 0);
    range.at<float>(5, 5) = depth.at<float>(5, 5);
    EXPECT_LT(cv::norm(range, depth, cv::NORM_INF), 1e-6);
}

}  // namespace
}  // namespace roevo
