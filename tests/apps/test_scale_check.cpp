// Ground truth that contradicts the scale of depth.
#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/scale_check.h"
#include "odometry_fixture.h"

namespace roevo {
namespace {

/// A bow of `length` metres in `count` poses.
std::vector<StampedPose> path(std::size_t count, double length, double noise = 0) {
    std::vector<StampedPose> poses;
    for (std::size_t i = 0; i < count; i++) {
        const auto n = static_cast<double>(i);
        const double along = n / static_cast<double>(count - 1);
        Pose pose = Pose::Identity();
        pose.translation() << length * along + noise * std::sin(7.3 * n),
            0.2 * length * std::sin(3 * along) + noise * std::cos(5.1 * n), noise * std::sin(3.7 * n);
        poses.push_back({n / 30, pose});
    }
    return poses;
}

std::string contradiction(const std::vector<StampedPose>& reference, std::vector<StampedPose> estimate,
                          double scale) {
    const Pose T_world(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(1, Eigen::Vector3d::UnitY()));
    for (StampedPose& pose : estimate) {
        pose.T_world_camera.translation() *= scale;
        pose.T_world_camera = T_world * pose.T_world_camera;
    }
    return scaleContradiction(reference, estimate, associate(reference, estimate, 0.02));
}

TEST(ScaleCheck, NamesTheFactorEitherWay) {
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 0.2),
              "the ground truth's path is 5 times as long as the estimate's: is the depth scale wrong by 5 "
              "(depths too small)?");
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 5),
              "the ground truth's path is 0.2 times as long as the estimate's: is the depth scale wrong by 5 "
              "(depths too large)?");
    EXPECT_NE(contradiction(path(40, 1, 0.005), path(40, 1, -0.003), 1 / 1.6), "") << "with noise";
}

TEST(ScaleCheck, NothingToSay) {
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 1), "");
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 1.45), "");
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 1 / 1.45), "");
}

TEST(ScaleCheck, WhatCannotTell) {
    EXPECT_EQ(contradiction(path(29, 1), path(29, 1), 0.2), "") << "too few poses";
    EXPECT_EQ(contradiction(path(40, 0.25), path(40, 0.25), 0.2), "") << "too short";
    EXPECT_EQ(contradiction(path(40, 1), path(40, 1), 0), "") << "an estimate that never moved";
    // A camera that stands still, measured with noise: a path, but no shape
    EXPECT_EQ(contradiction(path(400, 0.01, 0.005), path(400, 0.01, -0.02), 3), "");
}

class ScaleWarning : public test::OdometryProgram {
  protected:
    void SetUp() override {
        const auto made = test::runProgram(
            "rawlog-simulate", {"--scene", "livingroom", "--frames", "34", "--size", "160x120", "--speed",
                                "1", "--layout", "tum", "--output", folder_ / "sim"});
        ASSERT_EQ(made.exit_code, 0) << made.all();
        camera_ = test::readFile(folder_ / "sim/camera.txt");
    }

    /// Runs over a folder that says another depth scale than the true 5000.
    test::ProgramResult runWithScale(const std::string& scale,
                                     const std::vector<std::string>& more = {}) const {
        std::string camera = camera_;
        camera.replace(camera.find("depth_scale: 5000"), 17, "depth_scale: " + scale);
        test::writeFile(folder_ / "sim/camera.txt", camera);
        return run(folder_ / "sim", more);
    }

    std::string camera_;
};

TEST_F(ScaleWarning, IsWrittenWhereTheGroundTruthContradicts) {
    const auto wrong = runWithScale("25000");
    ASSERT_EQ(wrong.exit_code, 0) << wrong.all();
    const std::string warning = summary()["ground_truth"]["warning"];
    EXPECT_NE(warning.find("times as long as the estimate's: is the depth scale wrong by"), std::string::npos)
        << warning;
    EXPECT_NE(warning.find("depths too small"), std::string::npos) << warning;
    EXPECT_NE(wrong.err.find("roevo-odometry: warning: " + warning), std::string::npos) << wrong.all();
}

TEST_F(ScaleWarning, IsNotWrittenElsewhere) {
    for (const auto& [scale, first] : {std::pair("5000", "34"), {"25000", "20"}}) {
        const auto outcome = runWithScale(scale, {"--first", first});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
        EXPECT_EQ(summary()["ground_truth"]["warning"], "") << scale;
        EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.all();
    }
}

}  // namespace
}  // namespace roevo
