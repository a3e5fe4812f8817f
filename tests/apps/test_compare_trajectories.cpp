/// Trajectories of other programs beside the methods.
#include <gtest/gtest.h>

#include <filesystem>

#include "compare_fakes.h"
#include "compare_program.h"
#include "evaluation/trajectory_io.h"
#include "roevo-compare/given_trajectory.h"
#include "roevo-compare/run_method.h"
#include "support/csv.h"

namespace roevo {
namespace {

using test::expectError;
using test::readFile;
using test::writeFile;

// Frames of the fakes come at 1, 1.1, 1.2, ... s.
std::vector<StampedPose> posesAt(const std::vector<double>& stamps) {
    std::vector<StampedPose> poses;
    for (const double t : stamps) poses.push_back({t, Pose(Eigen::Translation3d(t, 0, 0))});
    return poses;
}

MethodRun runGiven(const std::vector<double>& stamps, std::size_t frames, const std::string& folder) {
    test::FakeSource source(frames);
    GivenTrajectory given("file", posesAt(stamps));
    return runMethod(given, {}, source, 0, folder);
}

TEST(GivenTrajectory, FramesHaveThePoseOfTheirTimeAndEachPoseIsOfOneFrame) {
    const test::TemporaryFolder folder;
    // Before the first frame; near 1.0 twice; right at 1.1; too far from 1.2; near 1.3 and 1.4; after the
    // last
    const MethodRun run =
        runGiven({0.5, 0.985, 1.01, 1.1, 1.225, 1.31, 1.39, 1.6}, 5, folder.path().string());
    EXPECT_EQ(run.frames, 5u);
    EXPECT_EQ(run.tracked, 4u);
    std::vector<double> stamps;
    for (const StampedPose& pose : run.trajectory) {
        stamps.push_back(pose.timestamp);
        EXPECT_EQ(pose.T_world_camera.translation().x(), pose.timestamp) << "with its own pose";
    }
    EXPECT_EQ(stamps, (std::vector<double>{1.01, 1.1, 1.31, 1.39}));
    EXPECT_NE(readFile(folder / "frames.csv").find("1.200000,0,no pose within 0.02 s"), std::string::npos);
}

TEST(GivenTrajectory, APoseBetweenTwoFramesIsOfOneOfThem) {
    const test::TemporaryFolder folder;
    test::FakeSource source(3);
    source.frames[1].timestamp = source.frames[1].frame.timestamp = 1.015;
    GivenTrajectory given("file", posesAt({1.01}));
    const MethodRun run = runMethod(given, {}, source, 0, folder.path().string());
    EXPECT_EQ(run.tracked, 1u);
    EXPECT_EQ(run.trajectory.size(), 1u);
}

TEST(GivenTrajectory, WithoutACommonTimeBothTimesAreSaid) {
    const test::TemporaryFolder folder;
    try {
        runGiven({100, 101}, 3, folder.path().string());
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find(
                      "no pose of file is within 0.02 s of a frame: frames are from 1.000000 "
                      "to 1.200000 s, its poses from 100.000000 to 101.000000 s"),
                  std::string::npos)
            << e.what();
    }
}

class CompareTrajectories : public test::CompareProgram {
  protected:
    // The clip's ground truth with 1 cm up and down.
    std::vector<StampedPose> estimateOf(const std::string& input) const {
        auto poses = readTumTrajectory(input + "/groundtruth.txt");
        for (std::size_t i = 0; i < poses.size(); ++i)
            poses[i].T_world_camera.translation().z() += i % 2 ? 0.01 : -0.01;
        return poses;
    }
    std::string written(const std::string& name, const std::string& text) const {
        writeFile(folder / name, text);
        return folder / name;
    }
    std::map<std::string, std::string> row(const std::string& method) const {
        for (const auto& row : test::parseCsv(table()))
            if (row.at("method") == method) return row;
        ADD_FAILURE() << "no " << method << " in\n" << table();
        return {};
    }
};

TEST_F(CompareTrajectories, StandBesideTheMethodsWithoutTimes) {
    const std::string input = clip("clip", 8);
    const auto poses = estimateOf(input);
    writeTumTrajectory(folder / "tum.txt", poses);
    std::string kitti;
    for (const StampedPose& pose : poses) {
        const Eigen::Vector3d t = pose.T_world_camera.translation();
        kitti += "1 0 0 " + std::to_string(t.x()) + " 0 1 0 " + std::to_string(t.y()) + " 0 0 1 " +
                 std::to_string(t.z()) + "\n";
    }
    const auto result =
        run({input}, {"--methods", "roevo-ct", "--trajectory", "Theirs, <2>=" + (folder / "tum.txt"),
                      "Kitti=" + written("k.txt", kitti)});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("Kitti: 8 of 8 frames have a pose"), std::string::npos) << result.err;

    const auto expected = evaluate(readTumTrajectory(input + "/groundtruth.txt"), poses);
    for (const char* name : {"Theirs, <2>", "Kitti"}) {
        const auto theirs = row(name);
        EXPECT_EQ(theirs.at("label"), name);
        EXPECT_EQ(theirs.at("status"), "ok");
        EXPECT_EQ(theirs.at("frames_tracked"), "8");
        EXPECT_NEAR(std::stod(theirs.at("ate_rmse_m")), expected.ate.translation.rmse, 1e-8);
        EXPECT_NE(theirs.at("note").find("another program"), std::string::npos);
        for (const auto& [column, value] : theirs) {
            const bool is_cost = column.find("time_") != std::string::npos || column == "memory_peak_mb";
            EXPECT_TRUE(value.empty() || !is_cost) << column << ": " << value;
        }
    }
    EXPECT_NE(row("roevo-ct").at("time_total_median_ms"), "");
    EXPECT_LT(table().find("\nclip,roevo-ct,"), table().find("\nclip,Kitti,"));

    const std::size_t line = result.out.find("Theirs, <2>");
    ASSERT_NE(line, std::string::npos) << result.out;
    const std::string shown = result.out.substr(line, result.out.find('\n', line) - line);
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '-'), 2 + 4)
        << "less than a second has no RPE; time twice, processor time, memory: " << shown;
    const std::string page = readFile(output() + "/report.html");
    EXPECT_NE(page.find("Theirs, &lt;2&gt;"), std::string::npos);
    EXPECT_NE(page.find("made by another program, not run here"), std::string::npos);

    const auto again =
        test::runProgram("roevo-compare", {"--report", output() + "/runs", "--output", folder / "report"});
    ASSERT_EQ(again.exit_code, 0) << again.all();
    EXPECT_EQ(readFile(folder / "report/table.csv"), table());
    EXPECT_EQ(kept("clip", "Kitti").trajectory_file, folder / "k.txt");
}

TEST_F(CompareTrajectories, ThoseThatBelongToOtherTimesAreFailuresInTheTable) {
    const std::string input = clip("clip", 5);
    const auto result =
        run({input}, {"--methods", "roevo-ct", "--trajectory",
                      "late=" + written("late.txt", "900 0 0 0 0 0 0 1\n901 0 0 0 0 0 0 1\n"), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(row("late").at("status"), "failed");
    EXPECT_NE(row("late").at("reason").find("poses from 900.000000 to 901.000000 s"), std::string::npos);
    EXPECT_EQ(row("roevo-ct").at("status"), "ok");
}

TEST_F(CompareTrajectories, BadFilesEndItBeforeAnyRun) {
    const std::string input = clip("clip", 4), good = "1 0 0 0 0 0 0 1\n";
    const auto expect = [&](const std::string& text, const std::vector<std::string>& words) {
        expectError(run({input}, {"--methods", "roevo-ct", "--trajectory", "x=" + written("x.txt", text)}), 1,
                    "roevo-compare", words);
        EXPECT_FALSE(std::filesystem::exists(output())) << text;
    };
    expect(good + "2 0 0\n", {"x.txt:2: expected 8 numbers", "found 3"});
    expect(good + "2 0 nan 0 0 0 0 1\n", {"x.txt:2: 'nan' is not finite"});
    expect(good + "2 0 0 0 0 0 0 0\n", {"x.txt:2: the quaternion has length 0"});
    expect("1 0 0 0 0 1 0 0 0 0 1 0\n", {"x.txt:1: the last of 1 rows", "expected 4", "groundtruth.txt"});
    expectError(run({input}, {"--trajectory", "x=" + (folder / "none.txt")}), 1, "roevo-compare",
                {"cannot read", "none.txt"});
}

TEST_F(CompareTrajectories, NamesMustBeFitForTablesAndFolders) {
    const std::string input = clip("clip", 3), file = input + "/groundtruth.txt";
    const auto expect = [&](const std::vector<std::string>& given, const std::string& words) {
        std::vector<std::string> more{"--methods", "roevo-ct", "--trajectory"};
        more.insert(more.end(), given.begin(), given.end());
        expectError(run({input}, more), 2, "roevo-compare", {"--trajectory", words});
    };
    expect({file}, "expected NAME=FILE");
    expectError(run({input}, {"--trajectory", "=" + file}), 2, "roevo-compare",
                {"'=" + file + "' is not NAME=FILE"});
    expectError(run({input}, {"--trajectory", "a="}), 2, "roevo-compare", {"'a=' is not NAME=FILE"});
    expect({"a=" + file, "a=" + file}, "there twice");
    expect({"icp-frame=" + file}, "the name of a method");
    expect({"ROEVO TR=" + file}, "the name of a method");
    expect({"roevo-mine=" + file}, "begin with roevo");
    expect({"a/b=" + file}, "fit for a folder");
    expect({".a=" + file}, "fit for a folder");
    expect({"a@b=" + file}, "fit for a folder");
    expect({"a.partial=" + file}, "fit for a folder");
    expect({"a\nb=" + file}, "printable");
    expect({std::string(61, 'n') + "=" + file}, "60 printable characters");
    expectError(run({input, input}, {"--trajectory", "a=" + file}), 2, "roevo-compare",
                {"--trajectory is for a single --input"});
    expectError(
        test::runProgram("roevo-compare", {"--report", input, "--output", output(), "--trajectory", "a=b"}),
        2, "roevo-compare", {"--trajectory is for a single --input"});
    EXPECT_FALSE(std::filesystem::exists(output()));
}

}  // namespace
}  // namespace roevo
