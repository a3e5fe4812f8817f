// Undistortion: a pattern drawn as the lens sees it comes out as the ideal camera sees it.
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "camera/undistorter.h"
#include "core/support/analytic_image.h"

namespace roevo {
namespace {

double waves(double x, double y) {
    return 128 + 50 * std::sin(0.11 * x + 0.3) + 50 * std::cos(0.09 * y - 0.02 * x);
}

TEST(Undistorter, RestoresAPatternSeenThroughTheLens) {
    const PinholeCamera camera{320, 240, 260, 258, 158, 122, {0.26, -0.95, -0.005, 0.0026, 1.16}};
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const std::vector<double> lens(camera.distortion.begin(), camera.distortion.end());
    // What the lens sees at each pixel, by OpenCV's inverse lens, so that ours is not tested against itself
    std::vector<cv::Point2d> pixels, ideal;
    for (int v = 0; v < 240; ++v) {
        for (int u = 0; u < 320; ++u) pixels.emplace_back(u, v);
    }
    cv::undistortPoints(pixels, ideal, K, lens, cv::noArray(), K);
    cv::Mat seen(240, 320, CV_8UC1);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        seen.at<std::uint8_t>(static_cast<int>(pixels[i].y), static_cast<int>(pixels[i].x)) =
            cv::saturate_cast<std::uint8_t>(waves(ideal[i].x, ideal[i].y));
    }
    const Undistorter undistorter(camera);
    EXPECT_FALSE(undistorter.isIdentity());
    cv::Mat buffer;
    const cv::Mat& restored = undistorter.apply(seen, buffer);
    double worst = 0, without = 0;
    for (int v = 12; v < 228; ++v) {
        for (int u = 12; u < 308; ++u) {
            worst = std::max(worst, std::abs(restored.at<std::uint8_t>(v, u) - waves(u, v)));
            without = std::max(without, std::abs(seen.at<std::uint8_t>(v, u) - waves(u, v)));
        }
    }
    EXPECT_LT(worst, 3);
    EXPECT_GT(without, 10) << "the lens should have changed the picture, else this shows nothing";
}

TEST(Undistorter, IdealLensGivesTheImageItself) {
    const Undistorter undistorter(PinholeCamera{64, 48, 60, 60, 31, 23, {}});
    EXPECT_TRUE(undistorter.isIdentity());
    const cv::Mat image(48, 64, CV_8UC1, cv::Scalar(7));
    cv::Mat buffer;
    EXPECT_EQ(undistorter.apply(image, buffer).data, image.data);
}

}  // namespace
}  // namespace roevo
