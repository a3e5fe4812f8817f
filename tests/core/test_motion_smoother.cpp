// What becomes of measured poses when it is known that cameras have mass.
#include <gtest/gtest.h>

#include <random>

#include "odometry/motion_smoother.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kFrame = 1.0 / 30;

/// A hand that sways and turns, a few times per second at most.
Pose swaying(double seconds) {
    const Eigen::Vector3d place(0.2 * std::sin(3 * seconds), 0.1 * std::cos(5 * seconds), 0.3 * seconds);
    return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::sin(2 * seconds), Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(0.2 * std::cos(4 * seconds), Eigen::Vector3d::UnitX())),
                place);
}

Matrix6d sigmas(double position, double turn) {
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(position * position), Eigen::Vector3d::Constant(turn * turn);
    return variances.asDiagonal();
}

/// The motion, each pose off by what `covariance` (along the camera's axes) makes likely.
std::vector<MotionSample> measured(int count, const Matrix6d& covariance, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const Matrix6d root = covariance.llt().matrixL();
    std::vector<MotionSample> samples;
    for (int i = 0; i < count; ++i) {
        const Vector6d error = root * Vector6d::NullaryExpr([&] { return normal(generator); });
        Vector6d turn = Vector6d::Zero();
        turn.tail<3>() = error.tail<3>();
        Pose pose = swaying(kFrame * i);
        pose.translation() += pose.linear() * error.head<3>();
        pose.setRotation(pose.rotation() * poseIncrement(turn).rotation());
        samples.push_back({kFrame * i, pose, covariance});
    }
    return samples;
}

/// Root mean square of how far positions (m) and orientations (rad) are from that motion.
std::pair<double, double> errorOf(const std::vector<MotionSample>& samples) {
    double position = 0, turn = 0;
    for (const MotionSample& sample : samples) {
        const Pose off = swaying(sample.timestamp).inverse() * sample.T_world_camera;
        position += off.translation().squaredNorm();
        turn += std::pow(rotationAngle(off), 2);
    }
    const auto count = static_cast<double>(samples.size());
    return {std::sqrt(position / count), std::sqrt(turn / count)};
}

TEST(MotionSmoother, TakesMostOfWhiteNoiseFromASmoothMotion) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        std::vector<MotionSample> samples = measured(150, sigmas(0.002, 0.002), seed);
        const auto [position, turn] = errorOf(samples);
        smoothMotion(samples);
        const auto [smooth_position, smooth_turn] = errorOf(samples);
        EXPECT_LT(smooth_position, 0.7 * position) << seed;
        EXPECT_LT(smooth_turn, 0.7 * turn) << seed;
    }
}

TEST(MotionSmoother, WhatErrsTogetherIsMendedTogether) {
    // A turn and a shift that look alike to the camera: together they are 5 mm and 5 mrad off, apart 0.2
    Matrix6d covariance = sigmas(0.0002, 0.0002);
    Vector6d alike = Vector6d::Zero();
    alike[1] = alike[3] = 0.005;
    covariance += alike * alike.transpose();
    std::vector<MotionSample> samples = measured(150, covariance, 1);
    const auto [position, turn] = errorOf(samples);
    smoothMotion(samples);
    const auto [smooth_position, smooth_turn] = errorOf(samples);
    EXPECT_LT(smooth_position, 0.5 * position);
    EXPECT_LT(smooth_turn, 0.5 * turn);
}

TEST(MotionSmoother, APoseThatIsWellKnownStaysThoughTheCameraJerks) {
    std::vector<MotionSample> samples = measured(60, sigmas(0.0002, 0.0001), 3);
    samples[30].T_world_camera.translation().x() += 0.005;  // 25 sigma
    const std::vector<MotionSample> before = samples;
    smoothMotion(samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Pose moved = before[i].T_world_camera.inverse() * samples[i].T_world_camera;
        EXPECT_LT(moved.translation().norm(), 0.0008) << i;
    }
}

TEST(MotionSmoother, WithoutNoiseNothingMoves) {
    std::vector<MotionSample> samples;
    for (int i = 0; i < 90; ++i) samples.push_back({kFrame * i, swaying(kFrame * i), sigmas(0.002, 0.002)});
    smoothMotion(samples);
    const auto [position, turn] = errorOf(samples);
    EXPECT_LT(position, 0.0003);
    EXPECT_LT(turn, 0.0003);
}

TEST(MotionSmoother, WhatIsExactStaysToTheBit) {
    std::vector<MotionSample> samples = measured(30, sigmas(0.002, 0.002), 4);
    for (const std::size_t i : {0U, 10U, 20U}) samples[i].covariance.setZero();
    const std::vector<MotionSample> before = samples;
    smoothMotion(samples);
    for (const std::size_t i : {0U, 10U, 20U})
        EXPECT_EQ(samples[i].T_world_camera.matrix(), before[i].T_world_camera.matrix());
    EXPECT_NE(samples[11].T_world_camera.matrix(), before[11].T_world_camera.matrix());
}

TEST(MotionSmoother, IsTheSameBackwards) {
    std::vector<MotionSample> forwards = measured(60, sigmas(0.002, 0.001), 5), backwards;
    forwards[20].measured = forwards[21].measured = false;
    for (auto it = forwards.rbegin(); it != forwards.rend(); ++it) {
        backwards.push_back(*it);
        backwards.back().timestamp *= -1;
    }
    smoothMotion(forwards);
    smoothMotion(backwards);
    for (std::size_t i = 0; i < forwards.size(); ++i) {
        const Pose apart =
            forwards[i].T_world_camera.inverse() * backwards[forwards.size() - 1 - i].T_world_camera;
        EXPECT_LT(apart.translation().norm() + rotationAngle(apart), 5e-5) << i;
    }
}

TEST(MotionSmoother, WhatWasNotMeasuredIsBridged) {
    std::vector<MotionSample> samples = measured(60, sigmas(0.0005, 0.0005), 6);
    for (std::size_t i = 25; i < 35; ++i) {  // a third of a second: a straight line is up to 2.5 cm off
        samples[i].measured = false;
        samples[i].T_world_camera = Pose::Identity();
    }
    smoothMotion(samples);
    for (const MotionSample& sample : samples) {
        const Pose off = swaying(sample.timestamp).inverse() * sample.T_world_camera;
        EXPECT_LT(off.translation().norm(), 0.007) << sample.timestamp;
        EXPECT_LT(rotationAngle(off), 0.02) << sample.timestamp;
    }
}

TEST(MotionSmoother, NobodyKnowsWhereACameraWasForALongTime) {
    std::vector<MotionSample> samples = measured(120, sigmas(0.0005, 0.0005), 7);
    for (std::size_t i = 40; i < 80; ++i) samples[i].measured = false;
    smoothMotion(samples);
    const Pose &from = samples[39].T_world_camera, &to = samples[80].T_world_camera;
    for (std::size_t i = 40; i < 80; ++i) {
        const double share = static_cast<double>(i - 39) / 41;
        const Eigen::Vector3d line = (1 - share) * from.translation() + share * to.translation();
        EXPECT_LT((samples[i].T_world_camera.translation() - line).norm(), 0.005) << i;
    }
}

TEST(MotionSmoother, TakesWhateverComes) {
    std::vector<MotionSample> none;
    smoothMotion(none);
    std::vector<MotionSample> two = measured(2, sigmas(1, 1), 8);
    const std::vector<MotionSample> before = two;
    smoothMotion(two);
    EXPECT_EQ(two[1].T_world_camera.matrix(), before[1].T_world_camera.matrix());

    std::vector<MotionSample> odd = measured(40, sigmas(0.002, 0.002), 9);
    odd[5].timestamp = odd[4].timestamp + 1e-9;
    odd[10].covariance = 1e12 * Matrix6d::Identity();
    odd[15].covariance = 1e-30 * Matrix6d::Identity();
    odd[20].T_world_camera.translation().x() += 1000;
    for (std::size_t i = 25; i < odd.size(); ++i) odd[i].T_world_camera = odd[25].T_world_camera;
    smoothMotion(odd);
    for (const MotionSample& sample : odd) EXPECT_TRUE(sample.T_world_camera.isFinite());
}

}  // namespace
}  // namespace roevo
