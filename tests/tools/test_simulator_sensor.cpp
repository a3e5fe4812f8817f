// What the simulated sensor adds: depth noise, holes, exposure, blur, rolling shutter.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulator_check.h"

namespace roevo::simulator {
namespace {

/// Squared: the plain mean does not change when an edge is smeared out.
double meanSquaredGradient(const cv::Mat& grey) {
    cv::Mat dx;
    cv::Sobel(grey, dx, CV_32F, 1, 0);
    return cv::mean(dx.mul(dx))[0];
}

TEST(SimulatedSensor, WithoutNoiseMeasuredDepthIsExact) {
    const SimulatedFrame frame = Simulator(smallOptions("livingroom")).frame(3);
    EXPECT_EQ(cv::norm(frame.depth, frame.depth_noisy, cv::NORM_INF), 0);
    const cv::Mat stored = quantiseDepth(frame.depth);
    for (int v = 0; v < 120; v += 7)
        for (int u = 0; u < 160; u += 7)
            EXPECT_NEAR(stored.at<uint16_t>(v, u) / 5000., frame.depth.at<float>(v, u), 1.001e-4);
}

TEST(SimulatedSensor, DepthNoiseHasThePublishedSizeAndGrowsWithTheSquare) {
    SimulationOptions options = smallOptions("livingroom");
    options.width = 320, options.height = 240;
    options.depth_noise = 1;
    const Simulator simulator(options);
    for (const double z : {1.6, 2.2, 3.2}) {
        double sum = 0, sum2 = 0, neighbours = 0;
        int count = 0;
        for (int index = 0; index < 300; index += 25) {
            const SimulatedFrame frame = simulator.frame(index);
            for (int v = 4; v + 4 < 240; ++v)
                for (int u = 4; u + 4 < 320; ++u) {
                    const float exact = frame.depth.at<float>(v, u);
                    if (std::abs(exact - z) > 0.15) continue;
                    const double error = (frame.depth_noisy.at<float>(v, u) - exact) / (exact * exact);
                    double beside =
                        (frame.depth_noisy.at<float>(v, u + 1) - frame.depth.at<float>(v, u + 1)) /
                        (exact * exact);
                    if (std::abs(error) > 0.012 || std::abs(beside) > 0.012)
                        continue;  // jitter across a border
                    sum += error;
                    sum2 += error * error;
                    neighbours += error * beside;
                    ++count;
                }
        }
        ASSERT_GT(count, 2000) << "at " << z << " m";
        const double deviation = std::sqrt(sum2 / count - sum / count * sum / count);
        EXPECT_NEAR(deviation, 1.425e-3, 0.15 * 1.425e-3) << "at " << z << " m";
        EXPECT_LT(std::abs(sum / count), 0.2e-3);
        EXPECT_GT(neighbours / sum2, 0.2) << "neighbours are a little correlated";
    }
}

TEST(SimulatedSensor, HolesAreWhereASensorHasThem) {
    SimulationOptions options = smallOptions("livingroom");
    options.width = 640, options.height = 480;
    const SimulatedFrame without = Simulator(options).frame(0);
    options.holes = true;
    const SimulatedFrame with = Simulator(options).frame(0);
    EXPECT_EQ(cv::countNonZero(without.depth_noisy == 0), 0);
    const double missing = cv::countNonZero(with.depth_noisy == 0) / static_cast<double>(with.depth.total());
    EXPECT_GT(missing, 0.005);
    EXPECT_LT(missing, 0.3);
    // The projector's shadow lies left of what stands in front.
    int left = 0, right = 0;
    for (int v = 0; v < 480; ++v)
        for (int u = 5; u + 5 < 640; ++u) {
            if (with.depth_noisy.at<float>(v, u) > 0) continue;
            left += with.depth.at<float>(v, u + 5) < 0.8f * with.depth.at<float>(v, u);
            right += with.depth.at<float>(v, u - 5) < 0.8f * with.depth.at<float>(v, u);
        }
    EXPECT_GT(left, 2 * right);
    // Beyond the sensor's range nothing is measured.
    SimulationOptions far = smallOptions("corridor");
    far.holes = true;
    const SimulatedFrame corridor = Simulator(far).frame(0);
    EXPECT_GT(cv::countNonZero(corridor.depth > 8), 0);
    EXPECT_EQ(cv::countNonZero((corridor.depth > 8) & (corridor.depth_noisy > 0)), 0);
}

TEST(SimulatedSensor, ExposureDriftChangesBrightnessOnly) {
    SimulationOptions options = smallOptions("livingroom");
    const Simulator steady(options);
    options.exposure_drift = 0.3;
    const Simulator drifting(options);
    double least = 1e9, most = 0;
    for (int index = 0; index < 240; index += 20) {
        const SimulatedFrame a = steady.frame(index), b = drifting.frame(index);
        const double ratio = cv::mean(b.grey)[0] / cv::mean(a.grey)[0];
        least = std::min(least, ratio);
        most = std::max(most, ratio);
        EXPECT_EQ(cv::norm(a.depth, b.depth, cv::NORM_INF), 0);
    }
    EXPECT_LT(least, 0.8);
    EXPECT_GT(most, 1.1);
}

TEST(SimulatedSensor, MotionBlurSmoothsThePictureAndLeavesDepth) {
    SimulationOptions options = smallOptions("livingroom");
    const SimulatedFrame sharp = Simulator(options).frame(50);
    options.motion_blur = 0.03;
    const SimulatedFrame blurred = Simulator(options).frame(50);
    EXPECT_LT(meanSquaredGradient(blurred.grey), 0.93 * meanSquaredGradient(sharp.grey));
    EXPECT_NEAR(cv::mean(blurred.grey)[0], cv::mean(sharp.grey)[0], 1.5);
    EXPECT_EQ(cv::norm(sharp.depth, blurred.depth, cv::NORM_INF), 0);
}

TEST(SimulatedSensor, RollingShutterReadsEveryRowAtItsTime) {
    SimulationOptions options = smallOptions("livingroom");
    options.rolling_shutter = 0.03;
    const Simulator simulator(options);
    const int index = 50;
    const SimulatedFrame frame = simulator.frame(index);
    double worst = 0, worst_unaware = 0;
    for (int v = 0; v < 120; ++v) {
        const Pose T_world_row = simulator.poseAt(index / 30. + 0.03 * ((v + 0.5) / 120 - 0.5));
        for (int u = 0; u < 160; ++u) {
            const auto& primitive =
                simulator.scene().primitives[static_cast<size_t>(frame.objects.at<int>(v, u))];
            const Eigen::Vector3d point = simulator.camera().backProject(u, v, frame.depth.at<float>(v, u));
            worst = std::max(worst, distanceToSurface(primitive, T_world_row * point));
            worst_unaware =
                std::max(worst_unaware, distanceToSurface(primitive, frame.T_world_camera * point));
        }
    }
    EXPECT_LT(worst, 1e-5);
    EXPECT_GT(worst_unaware, 1e-3);
}

TEST(SimulatedSensor, RollingShutterOfACameraThatHardlyMovesChangesNothing) {
    SimulationOptions options = smallOptions("livingroom");
    const SimulatedFrame global = Simulator(options).frame(50);
    options.rolling_shutter = 1e-9;
    const SimulatedFrame rolling = Simulator(options).frame(50);
    EXPECT_LT(cv::norm(global.depth, rolling.depth, cv::NORM_L1) / static_cast<double>(global.depth.total()),
              1e-6);
    EXPECT_LT(cv::countNonZero(global.grey != rolling.grey), 20);
}

}  // namespace
}  // namespace roevo::simulator
