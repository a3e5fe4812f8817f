#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "evaluation/alignment.h"
#include "evaluation/evaluate.h"
#include "evaluation/trajectory_io.h"
#include "support/data_folder.h"

namespace roevo {
namespace {

constexpr double kPi = 3.14159265358979323846;

Pose somePose() {
    return Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
}

// A curve with rotation, 10 Hz.
std::vector<StampedPose> curve(std::size_t count) {
    std::vector<StampedPose> poses(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = 0.1 * static_cast<double>(i);
        poses[i].timestamp = 100 + t;
        poses[i].T_world_camera = Eigen::Translation3d(std::sin(t), t * 0.3, std::cos(2 * t)) *
                                  Eigen::AngleAxisd(0.4 * t, Eigen::Vector3d::UnitY());
    }
    return poses;
}

TEST(ErrorStatistics, OfAKnownList) {
    const auto s = errorStatistics({4, 1, 3, 2});
    EXPECT_DOUBLE_EQ(s.mean, 2.5);
    EXPECT_DOUBLE_EQ(s.median, 2.5);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
    EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
    EXPECT_DOUBLE_EQ(s.min, 1);
    EXPECT_DOUBLE_EQ(s.max, 4);
    EXPECT_EQ(s.count, 4u);
    EXPECT_EQ(errorStatistics({}).count, 0u);
    EXPECT_DOUBLE_EQ(percentile({0, 10, 20}, 0.75), 15);
}

TEST(Association, TakesTheNearestOnceEach) {
    const auto at = [](std::initializer_list<double> times) {
        std::vector<StampedPose> poses;
        for (const double t : times) poses.push_back({t, Pose::Identity()});
        return poses;
    };
    // 1.010 is nearer to 1.011 than to 1.000, and must not be given away to 1.000.
    const auto pairs = associate(at({1.000, 1.011, 2.0}), at({1.010, 1.992, 1.994, 5.0}), 0.02);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].reference, 1u);
    EXPECT_EQ(pairs[0].estimate, 0u);
    EXPECT_EQ(pairs[1].reference, 2u);
    EXPECT_EQ(pairs[1].estimate, 2u);
    EXPECT_TRUE(associate(at({1}), at({2}), 0.5).empty());
}

TEST(Alignment, RecoversAMotionWithoutScaleOrMirror) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector3d> source, target, scaled;
    for (int i = 0; i < 20; ++i) {
        source.emplace_back(normal(random), normal(random), normal(random));
        target.push_back(somePose() * source.back());
        scaled.push_back(3 * source.back());
    }
    EXPECT_LT((alignRigidly(source, target).matrix() - somePose().matrix()).norm(), 1e-12);
    EXPECT_NEAR(alignRigidly(source, scaled).linear().determinant(), 1, 1e-12);
    source.resize(2);
    EXPECT_THROW(alignRigidly(source, source), std::invalid_argument);
}

TEST(Evaluation, AMovedCopyHasNoError) {
    const auto reference = curve(60);
    auto estimate = reference;
    for (StampedPose& pose : estimate) pose.T_world_camera = somePose() * pose.T_world_camera;
    const Evaluation e = evaluate(reference, estimate);
    EXPECT_EQ(e.pairs.size(), 60u);
    EXPECT_LT(e.ate.translation.max, 1e-12);
    EXPECT_LT(e.rpe_second.translation.max, 1e-12);
    EXPECT_LT(e.rpe_second.rotation.max, 1e-6);
    EXPECT_EQ(e.rpe_second.translation.count, 50u);
    EXPECT_EQ(e.rpe_frame.translation.count, 59u);
}

TEST(Evaluation, RelativeErrorsMeasureDriftPerSecondAndPerFrame) {
    const auto reference = curve(60);
    auto estimate = reference;
    for (std::size_t i = 1; i < estimate.size(); ++i) {
        const Pose motion = reference[i - 1].T_world_camera.inverse() * reference[i].T_world_camera;
        // Each frame turns 0.1 degrees too far, about the optical axis of the frame itself.
        const Pose wrong(Eigen::AngleAxisd(0.1 * kPi / 180, Eigen::Vector3d::UnitZ()));
        estimate[i].T_world_camera = estimate[i - 1].T_world_camera * motion * wrong;
    }
    const Evaluation e = evaluate(reference, estimate);
    EXPECT_NEAR(e.rpe_frame.rotation.rmse, 0.1, 1e-9);
    EXPECT_NEAR(e.rpe_second.rotation.mean, 1.0, 0.01);  // ten frames, axes a little apart
    EXPECT_LT(e.rpe_frame.translation.rmse, 1e-12);
}

TEST(Evaluation, RelativeErrorsMeasureDriftPerMetre) {
    // Along x, which the camera turns about: at first 1 cm per frame, then it stands, then 3 cm per frame.
    // The estimate is 3 % too long and turns 0.5 degrees per metre too far.
    std::vector<StampedPose> reference, estimate;
    std::vector<double> path;
    double x = 0;
    for (int i = 0; i < 220; ++i) {
        const auto turned = [&](double deg) {
            return Eigen::AngleAxisd(deg * kPi / 180, Eigen::Vector3d::UnitX());
        };
        path.push_back(x);
        reference.push_back({0.1 * i, Eigen::Translation3d(x, 0, 0) * turned(7 * x)});
        estimate.push_back({0.1 * i, Eigen::Translation3d(1.03 * x, 0, 0) * turned(7.5 * x)});
        x += i < 100 ? 0.01 : i < 120 ? 0 : 0.03;
    }
    const auto pairs = associate(reference, estimate, 0.02);
    for (const double length : {0.1, 0.5, 2.0}) {
        const RelativeError e = relativePoseErrorOverDistance(reference, estimate, pairs, length);
        std::size_t count = 0;
        for (const double from : path)
            count += std::any_of(path.begin(), path.end(),
                                 [&](double to) { return std::abs(to - from - length) <= 0.1 * length; });
        EXPECT_EQ(e.translation.count, count) << length;
        EXPECT_GT(count, 50u) << length;
        for (const double value : {e.translation.min, e.translation.max})
            EXPECT_NEAR(value, 0.03, 1e-9) << length;
        for (const double value : {e.rotation.min, e.rotation.max}) EXPECT_NEAR(value, 0.5, 1e-9) << length;
    }
    EXPECT_EQ(relativePoseErrorOverDistance(reference, estimate, pairs, 5).translation.count, 0u)
        << "too long";
    EXPECT_EQ(relativePoseErrorOverDistance(reference, estimate, {}, 1).translation.count, 0u);
}

TEST(Evaluation, ShorterThanASecondHasNoErrorPerSecond) {
    const auto reference = curve(6);
    const Evaluation e = evaluate(reference, reference);
    EXPECT_EQ(e.rpe_second.translation.count, 0u);
    EXPECT_EQ(e.rpe_frame.translation.count, 5u);
}

TEST(Evaluation, SaysWhatDecidesWhenThereIsNoOverlap) {
    const auto reference = curve(30);
    auto estimate = reference;
    for (StampedPose& pose : estimate) pose.timestamp += 3600;
    try {
        evaluate(reference, estimate);
        FAIL() << "should have thrown";
    } catch (const std::runtime_error& e) {
        for (const char* words : {"100.000000 s to 102.900000 s", "3700.000000 s to 3702.900000 s",
                                  "largest gap 0.100 s", "add -3600.000000 s", "then 30 poses are common"})
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << words << " in " << e.what();
    }
    estimate = {reference[0], reference[1]};
    EXPECT_THROW(evaluate(reference, estimate), std::runtime_error) << "two common poses are too few";
}

TEST(Evaluation, SuggestsOnlyWhatWouldHelp) {
    const auto complaint = [](const std::vector<StampedPose>& reference,
                              const std::vector<StampedPose>& estimate) -> std::string {
        try {
            evaluate(reference, estimate);
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "no error";
    };
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    const auto reference = curve(30);

    const auto one = complaint(reference, {reference[4]});
    EXPECT_TRUE(has(one, "only 1 pose has") && has(one, "too short")) << one;
    EXPECT_FALSE(has(one, "--offset") || has(one, "--max-dt")) << one;

    auto late = reference;  // the ranges touch, at one stamp
    for (StampedPose& pose : late) pose.timestamp += 2.9;
    EXPECT_TRUE(has(complaint(reference, late), "add -2.900000 s")) << complaint(reference, late);

    auto between = reference;
    for (StampedPose& pose : between) pose.timestamp += 0.05;
    EXPECT_TRUE(has(complaint(reference, between), "--max-dt")) << complaint(reference, between);

    // Sparse and of another length: starting together would not make it right either
    std::vector<StampedPose> sparse{reference[0], reference[1], reference[2]};
    for (std::size_t i = 0; i < sparse.size(); ++i)
        sparse[i].timestamp = 5000 + 7.77 * static_cast<double>(i);
    EXPECT_FALSE(has(complaint(reference, sparse), "--offset")) << complaint(reference, sparse);
}

TEST(Evaluation, StampsThatAreFarFromAllOthersAreOfAnotherClock) {
    std::vector<StampedPose> reference(4), estimate(3);
    for (std::size_t i = 0; i < 4; ++i) reference[i].timestamp = i < 2 ? static_cast<double>(i) : 100;
    reference[3].timestamp = 101;
    for (std::size_t i = 0; i < 3; ++i) estimate[i].timestamp = 40 + static_cast<double>(i);
    try {
        evaluate(reference, estimate);
        FAIL();
    } catch (const std::runtime_error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("39.000000 s apart; are the stamps in seconds"), std::string::npos) << text;
        EXPECT_EQ(text.find("--max-dt"), std::string::npos) << text;
    }
}

TEST(Evaluation, GoldenFiguresOfFr2Desk) {
    const std::string folder = test::dataFolder() + "/eval_fr2_desk/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
    const auto reference = readTumTrajectory(folder + "groundtruth.txt");
    const auto estimate = readTumTrajectory(folder + "estimate.txt");
    const auto micrometres = [](double metres) { return std::lround(metres * 1e6); };

    const auto evo = evaluate(reference, estimate, 0.01).ate.translation;
    EXPECT_EQ(micrometres(evo.rmse), 8119);
    EXPECT_EQ(micrometres(evo.mean), 7492);
    EXPECT_EQ(micrometres(evo.median), 7415);
    EXPECT_EQ(micrometres(evo.max), 24300);
    EXPECT_EQ(micrometres(evaluate(reference, estimate, 0.02).ate.translation.rmse), 8144);
}

TEST(CoveredPart, IsWhatIsInTheTimeOfATrajectory) {
    const auto reference = curve(30);
    const std::vector<StampedPose> part(reference.begin() + 10, reference.begin() + 15);
    const auto covered = coveredPart(reference, part);
    ASSERT_EQ(covered.size(), 5u);
    EXPECT_EQ(covered[0].timestamp, reference[10].timestamp);
    EXPECT_TRUE(coveredPart(reference, {}).empty());
}

TEST(PathLength, AddsUpSteps) {
    std::vector<StampedPose> poses(3);
    poses[1].T_world_camera.translation() = Eigen::Vector3d(3, 4, 0);
    EXPECT_DOUBLE_EQ(pathLength(poses), 10);
    EXPECT_EQ(pathLength({}), 0);
}

}  // namespace
}  // namespace roevo
