// Depth resampled for methods that know a field of view only: surfaces stay where they are, steps stay steps.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "analytic_room.h"
#include "methods/depth_resampler.h"

namespace roevo {
namespace {

using testing::AnalyticRoom;

PinholeCamera offCentre() {
    PinholeCamera camera;
    camera.width = 370;
    camera.height = 229;
    camera.fx = 363;
    camera.fy = 340;
    camera.cx = 150;
    camera.cy = 120;
    return camera;
}

TEST(CentredCamera, SeesAllThatTheCameraSees) {
    const PinholeCamera camera = offCentre(), centred = centredCamera(camera, 320, 240);
    EXPECT_EQ(centred.width, 320);
    EXPECT_EQ(centred.height, 240);
    EXPECT_EQ(centred.fx, centred.fy);
    EXPECT_EQ(centred.cx, 159.5);
    EXPECT_EQ(centred.cy, 119.5);
    double widest = 0;
    for (const double u : {-0.5, camera.width - 0.5}) {
        for (const double v : {-0.5, camera.height - 0.5}) {
            const Eigen::Vector2d pixel = centred.project(camera.backProject(u, v, 1));
            EXPECT_GE(pixel.x(), -0.5 - 1e-9);
            EXPECT_LE(pixel.x(), 319.5 + 1e-9);
            EXPECT_GE(pixel.y(), -0.5 - 1e-9);
            EXPECT_LE(pixel.y(), 239.5 + 1e-9);
            widest = std::max(widest, pixel.x());
        }
    }
    EXPECT_NEAR(widest, 319.5, 1e-9) << "no pixel is wasted";
}

TEST(CentredCamera, OfACentredOneIsTheSame) {
    PinholeCamera camera = offCentre();
    camera.fy = camera.fx;
    camera.height = 228;
    camera.cx = 184.5;
    camera.cy = 113.5;
    const PinholeCamera same = centredCamera(camera, 370, 228), half = centredCamera(camera, 185, 114);
    EXPECT_EQ(same.cx, camera.cx);
    EXPECT_EQ(same.cy, camera.cy);
    EXPECT_NEAR(same.fx, camera.fx, 1e-9);
    EXPECT_NEAR(half.fx, camera.fx / 2, 1e-9);
}

TEST(DepthResampler, TheRoomIsWhereTheOtherCameraSeesIt) {
    PinholeCamera camera = offCentre();
    for (const bool distorted : {false, true}) {
        if (distorted) camera.distortion = {0.26, -0.95, -0.005, 0.003, 1.16};
        const PinholeCamera centred = centredCamera(camera, 320, 240);
        cv::Mat depth;
        DepthResampler(camera, centred, SensorOptions())
            .apply(AnalyticRoom::frame(camera, Pose::Identity(), 0).depth, depth);
        const cv::Mat truth = AnalyticRoom::frame(centred, Pose::Identity(), 0).depth;
        ASSERT_EQ(depth.size(), truth.size());
        int known = 0, wrong = 0;
        for (int v = 0; v < 240; ++v) {
            for (int u = 0; u < 320; ++u) {
                const float z = depth.at<float>(v, u), exact = truth.at<float>(v, u);
                const Eigen::Vector2d seen = camera.project(centred.backProject(u, v, 1));
                const bool outside = seen.x() < -0.5 || seen.x() > camera.width - 0.5 || seen.y() < -0.5 ||
                                     seen.y() > camera.height - 0.5;
                if (outside) {
                    EXPECT_EQ(z, 0) << u << ", " << v;
                }
                if (z == 0) continue;
                ++known;
                if (std::abs(z - exact) > 0.002 * exact) ++wrong;
            }
        }
        EXPECT_GT(known, 0.5 * 320 * 240);
        RecordProperty("wrong", wrong);
        EXPECT_LT(wrong, 0.01 * known) << "but at the outlines, where either surface may be taken";
    }
}

TEST(DepthResampler, NothingIsMadeUpBetweenTwoSurfacesOrOutOfUnknownDepth) {
    PinholeCamera camera = offCentre();
    cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(1));
    depth.colRange(100, 200) = 2;
    depth.rowRange(60, 90) = 0;
    depth.rowRange(90, 100) = std::numeric_limits<float>::quiet_NaN();
    depth.rowRange(100, 110) = 9.5;  // beyond the limit
    depth.rowRange(110, 120) = 0.1;
    cv::Mat out;
    const DepthResampler resampler(camera, centredCamera(camera, 640, 480), SensorOptions());
    resampler.apply(depth, out);
    int zeros = 0, ones = 0, twos = 0;
    for (int v = 0; v < out.rows; ++v) {
        for (int u = 0; u < out.cols; ++u) {
            const float z = out.at<float>(v, u);
            zeros += z == 0;
            ones += z == 1;
            twos += z == 2;
        }
    }
    EXPECT_EQ(zeros + ones + twos, 640 * 480);
    EXPECT_GT(ones, 0);
    EXPECT_GT(twos, 0);
    resampler.apply(depth, out, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(countKnown(out), ones + twos);
    int unknown = 0;
    for (int v = 0; v < out.rows; ++v)
        for (int u = 0; u < out.cols; ++u) unknown += std::isnan(out.at<float>(v, u));
    EXPECT_EQ(unknown, zeros);
}

}  // namespace
}  // namespace roevo
