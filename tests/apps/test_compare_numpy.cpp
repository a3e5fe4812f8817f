// The errors in table.csv against evaluate_with_numpy.py, which was written from the protocol's text.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "evaluation/trajectory_io.h"
#include "report_fixture.h"
#include "support/data_folder.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::makeInfo;
using test::makeRun;
using test::makeSequence;
using test::TemporaryFolder;

constexpr double kTolerance = 1e-6;  // m, deg

class AgainstNumpy : public testing::Test {
  protected:
    void SetUp() override {
        if (!fs::exists(test::kPython) ||
            test::runProgram(test::kPython, {"-c", "import numpy"}).exit_code != 0)
            GTEST_SKIP() << "no numpy for " << test::kPython << " (package python3-numpy)";
    }

    static nlohmann::json recompute(const std::string& reference, const std::string& estimate) {
        const auto result = test::runProgram(
            test::kPython,
            {std::string(ROEVO_SOURCE_DIR) + "/tests/evaluate_with_numpy.py", reference, estimate});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return nlohmann::json::parse(result.out, nullptr, false);
    }

    static void expectEqual(const std::map<std::string, std::string>& row, const nlohmann::json& truth) {
        EXPECT_EQ(row.at("associated_poses"), std::to_string(truth["pairs"].get<int>()));
        const auto compare = [&](const std::string& name, const std::string& unit,
                                 const nlohmann::json& figures) {
            if (figures.is_null()) {
                EXPECT_EQ(row.at(name + "_rmse_" + unit), "") << name;
                return;
            }
            for (const char* figure : {"rmse", "mean", "median", "std", "max"})
                EXPECT_NEAR(std::stod(row.at(name + "_" + figure + "_" + unit)),
                            figures[figure].get<double>(), kTolerance)
                    << name << ' ' << figure;
            EXPECT_EQ(row.at(name + "_count"), std::to_string(figures["count"].get<int>())) << name;
        };
        compare("ate", "m", truth["ate_m"]);
        compare("rpe_second_translation", "m_per_s", truth["rpe_per_second"]["translation_m"]);
        compare("rpe_second_rotation", "deg_per_s", truth["rpe_per_second"]["rotation_deg"]);
        compare("rpe_frame_translation", "m", truth["rpe_per_frame"]["translation_m"]);
        compare("rpe_frame_rotation", "deg", truth["rpe_per_frame"]["rotation_deg"]);
    }

    /// Writes both, evaluates both ways and compares.
    void expectSame(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate) {
        writeTumTrajectory(folder_ / "reference.txt", reference);
        writeTumTrajectory(folder_ / "estimate.txt", estimate);
        auto sequence = makeSequence("s", {makeRun("a", 0)});
        // As the programs get them: from files
        sequence.reference = readTumTrajectory(folder_ / "reference.txt");
        sequence.runs[0].trajectory = readTumTrajectory(folder_ / "estimate.txt");
        const test::WrittenComparison out({sequence});
        expectEqual(out.row("s", "a"), recompute(folder_ / "reference.txt", folder_ / "estimate.txt"));
    }

    TemporaryFolder folder_;
};

// A ground truth at 100 Hz, an estimate at 30 Hz with noise and drift in a world of its own, stamps jittered.
struct Walk {
    std::vector<StampedPose> reference, estimate;
};

Walk randomWalk(unsigned seed, double seconds) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto motion = [](double t) {
        return Pose(Eigen::Translation3d(std::sin(t), 0.4 * t, std::cos(1.7 * t)) *
                    Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d(0.2, 1, -0.3).normalized()));
    };
    const Pose elsewhere =
        Eigen::Translation3d(4, -2, 1) * Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized());
    Walk walk;
    for (double t = 0; t < seconds; t += 0.01) walk.reference.push_back({1.3e9 + t, motion(t)});
    Pose drift = Pose::Identity();
    for (double t = 0.004; t < seconds; t += 1 / 30.0) {
        const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
        drift = drift * Pose(Eigen::Quaterniond(Eigen::AngleAxisd(0.001 * axis.norm(), axis.normalized())),
                             0.002 * axis);
        walk.estimate.push_back({1.3e9 + t + 0.001 * normal(random), elsewhere * motion(t) * drift});
    }
    return walk;
}

TEST_F(AgainstNumpy, RandomWalksWithGapsInBoth) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(seed);
        Walk walk = randomWalk(seed, 6);
        expectSame(walk.reference, walk.estimate);
        // Motion capture lost sight, and tracking was lost for a while
        walk.reference.erase(walk.reference.begin() + 150, walk.reference.begin() + 210);
        walk.estimate.erase(walk.estimate.begin() + 100, walk.estimate.begin() + 135);
        expectSame(walk.reference, walk.estimate);
    }
}

TEST_F(AgainstNumpy, StampsThatCompeteForOneAnother) {
    Walk walk = randomWalk(5, 3);
    // A ground truth at 25 Hz: some of its poses are the nearest of two frames
    std::vector<StampedPose> sparse;
    for (std::size_t i = 0; i < walk.reference.size(); i += 4) sparse.push_back(walk.reference[i]);
    expectSame(sparse, walk.estimate);
}

TEST_F(AgainstNumpy, ShorterThanASecond) {
    const Walk walk = randomWalk(7, 0.6);
    expectSame(walk.reference, walk.estimate);
}

TEST_F(AgainstNumpy, PublishedTrajectoryOfFr2Desk) {
    const std::string data = test::dataFolder() + "/eval_fr2_desk/";
    if (!fs::exists(data)) GTEST_SKIP() << data << " is not there; set ROEVO_DATA_DIR";
    expectSame(readTumTrajectory(data + "groundtruth.txt"), readTumTrajectory(data + "estimate.txt"));
}

TEST_F(AgainstNumpy, WhatRoevoCompareWrites) {
    test::writeTumFolder(folder_ / "recording", test::slidingRecording(40));
    const auto result = test::runProgram("roevo-compare", {"--input", folder_ / "recording", "--methods",
                                                           "roevo-ct,roevo-ba", "--output", folder_ / "out"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const auto rows = test::parseCsv(test::readFile(folder_ / "out/table.csv"));
    ASSERT_EQ(rows.size(), 2u);
    for (const auto& row : rows) {
        SCOPED_TRACE(row.at("method"));
        ASSERT_EQ(row.at("no_errors_because"), "");
        expectEqual(row, recompute(folder_ / "recording/groundtruth.txt",
                                   (fs::path(row.at("run_folder")) / "trajectory.txt").string()));
    }
}

}  // namespace
}  // namespace roevo
