// Pinhole model: projection, pyramid levels, lens, checks.
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/calib3d.hpp>

#include "core/support/analytic_image.h"
#include "core/support/random_pose.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/image_pyramid.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kCamera{640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};

TEST(PinholeCamera, BackProjectionInvertsProjection) {
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const double u = uniform(random, -50, 700), v = uniform(random, -50, 500),
                     z = uniform(random, 0.1, 20);
        const Eigen::Vector3d point = kCamera.backProject(u, v, z);
        EXPECT_DOUBLE_EQ(point.z(), z);
        EXPECT_LT((kCamera.project(point) - Eigen::Vector2d(u, v)).norm(), 1e-10);
    }
}

TEST(PinholeCamera, PrincipalPointIsOnTheAxis) {
    EXPECT_LT((kCamera.project({0, 0, 3}) - Eigen::Vector2d(318.6, 255.3)).norm(), 1e-12);
    EXPECT_NEAR(kCamera.project({0.1, 0, 1}).x() - 318.6, 51.73, 1e-9);
    EXPECT_NEAR(kCamera.project({0, 0.1, 1}).y() - 255.3, 51.65, 1e-9);
}

// The centroid of a blob is where its point projects, on every level of a pyramid that averages 2x2 pixels.
TEST(PinholeCamera, PyramidLevelsSeeAPointWhereThePyramidShowsIt) {
    const PinholeCamera camera{320, 240, 260, 265, 158.3, 121.9, {}};
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.21, -0.13, 2), Eigen::Vector3d(-0.6, 0.4, 2.5), Eigen::Vector3d(0, 0, 1)}) {
        const Eigen::Vector2d centre = camera.project(point);
        const cv::Mat image = testing::renderGrey(
            320, 240,
            [&](double x, double y) {
                return 250 *
                       std::exp(-((x - centre.x()) * (x - centre.x()) + (y - centre.y()) * (y - centre.y())) /
                                200);
            },
            2);
        ImagePyramid pyramid;
        pyramid.build(image, 4);
        ASSERT_EQ(pyramid.numLevels(), 4);
        for (int level = 0; level < 4; ++level) {
            const cv::Mat& at = pyramid.level(level);
            double sum = 0, sum_u = 0, sum_v = 0;
            for (int v = 0; v < at.rows; ++v) {
                for (int u = 0; u < at.cols; ++u) {
                    const double w = at.at<std::uint8_t>(v, u);
                    sum += w;
                    sum_u += w * u;
                    sum_v += w * v;
                }
            }
            const PinholeCamera scaled = camera.atPyramidLevel(level);
            EXPECT_EQ(scaled.width, at.cols);
            EXPECT_EQ(scaled.height, at.rows);
            const Eigen::Vector2d seen(sum_u / sum, sum_v / sum);
            EXPECT_LT((scaled.project(point) - seen).norm(), 0.02) << "level " << level;
        }
    }
}

TEST(PinholeCamera, PyramidOfARampKeepsItsValuesWhereTheCameraSays) {
    const PinholeCamera camera{128, 96, 100, 100, 63.2, 47.9, {}};
    const cv::Mat ramp = testing::renderGrey(
        128, 96, [](double x, double y) { return 20 + x + 0.75 * y; }, 1);
    ImagePyramid pyramid;
    pyramid.build(ramp, 3);
    for (int level = 0; level < pyramid.numLevels(); ++level) {
        const PinholeCamera scaled = camera.atPyramidLevel(level);
        for (int v = 0; v < scaled.height; v += 5) {
            for (int u = 0; u < scaled.width; u += 5) {
                const Eigen::Vector2d full = camera.project(scaled.backProject(u, v, 1));
                EXPECT_NEAR(pyramid.level(level).at<std::uint8_t>(v, u), 20 + full.x() + 0.75 * full.y(),
                            1.01);
            }
        }
    }
}

TEST(PinholeCamera, PyramidOfOddSizesStaysAligned) {
    const PinholeCamera camera{101, 77, 90, 90, 50, 38, {}};
    const cv::Mat ramp = testing::renderGrey(
        101, 77, [](double x, double y) { return 10 + x + y; }, 1);
    ImagePyramid pyramid;
    pyramid.build(ramp, 2);
    const PinholeCamera half = camera.atPyramidLevel(1);
    ASSERT_EQ(pyramid.level(1).cols, half.width);
    ASSERT_EQ(pyramid.level(1).rows, half.height);
    EXPECT_NEAR(pyramid.level(1).at<std::uint8_t>(37, 49), 10 + 98.5 + 74.5, 1.01);
}

TEST(PinholeCamera, LensIsThatOfOpenCv) {
    const cv::Matx33d K(kCamera.fx, 0, kCamera.cx, 0, kCamera.fy, kCamera.cy, 0, 0, 1);
    const std::vector<double> lens(kCamera.distortion.begin(), kCamera.distortion.end());
    std::mt19937 random(2);
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 500; ++i) {
        points.emplace_back(uniform(random, -0.6, 0.6), uniform(random, -0.5, 0.5), 1.0);
    }
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, lens, expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2d pixel =
            kCamera.distortPixel(kCamera.project({points[i].x, points[i].y, points[i].z}));
        EXPECT_LT(std::hypot(pixel.x() - expected[i].x, pixel.y() - expected[i].y), 1e-9);
    }
}

TEST(PinholeCamera, UndistortedHasAnIdealLensAndNothingElseChanged) {
    EXPECT_TRUE(kCamera.isDistorted());
    PinholeCamera ideal = kCamera.undistorted();
    EXPECT_FALSE(ideal.isDistorted());
    EXPECT_NE(ideal, kCamera);
    ideal.distortion = kCamera.distortion;
    EXPECT_EQ(ideal, kCamera);
}

TEST(PinholeCamera, CheckNamesWhatIsWrongAndItsValue) {
    EXPECT_EQ(kCamera.check(), "");
    const auto faultWith = [](auto&& change) {
        PinholeCamera camera = kCamera;
        change(camera);
        return camera.check();
    };
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    EXPECT_NE(faultWith([](auto& c) { c.width = 0; }).find("0x480"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.height = -480; }).find("640x-480"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fx = 0; }).find("fx = 0"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fy = -525; }).find("fy = -525"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.cx = 1000; }).find("1000"), std::string::npos);
    for (const double bad : {nan, inf}) {
        EXPECT_NE(faultWith([&](auto& c) { c.fx = bad; }), "");
        EXPECT_NE(faultWith([&](auto& c) { c.cy = bad; }), "");
        for (std::size_t k = 0; k < 5; ++k) {
            EXPECT_NE(faultWith([&](auto& c) { c.distortion[k] = bad; }).find("distortion"),
                      std::string::npos);
        }
    }
    EXPECT_NE(PinholeCamera().check(), "");
}

}  // namespace
}  // namespace roevo
