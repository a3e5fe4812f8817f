// Folders as people have them: the frames are those of the recording that they were made of.
#include <gtest/gtest.h>

#include <cstdio>
#include <opencv2/core.hpp>
#include <regex>

#include "mrpt/test_helpers.h"
#include "support/run_program.h"
#include "tools/folder_kinds.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using namespace test;

const DatasetReader& simulated() {
    static const TemporaryFolder folder;
    static const DatasetReader reader = [] {
        const auto result = runProgram(
            "rawlog-simulate", {"--scene", "shadows", "--frames", "10", "--noise", "kinect", "--speed", "2",
                                "--size", "160x120", "--intrinsics", "120.25", "121.5", "79.75", "60.125",
                                "--layout", "tum", "--output", folder / "walk"});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return openDataset(folder / "walk");
    }();
    return reader;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// The frames of a folder by way of a rawlog, for which the converter reads all of it back.
std::vector<std::string> rgbd2rawlog(const FolderKind& kind, const std::string& input,
                                     const std::string& output) {
    const auto arguments = kind.write(simulated(), input);
    const auto result =
        runProgram("rgbd2rawlog", joined({"--input", input, "--output", output, "--verify"}, arguments));
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("10 pairs of 160x120"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("30.0 Hz"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("median depth"), std::string::npos) << result.out;
    return arguments;
}

class FolderOfEveryKind : public testing::TestWithParam<FolderKind> {};
INSTANTIATE_TEST_SUITE_P(Inputs, FolderOfEveryKind, testing::ValuesIn(folderKinds()),
                         [](const auto& info) { return "_" + std::to_string(info.index); });

TEST_P(FolderOfEveryKind, GivesTheFramesThatItWasMadeOf) {
    SCOPED_TRACE(GetParam().name);
    const TemporaryFolder folder;
    rgbd2rawlog(GetParam(), folder / "input", folder / "o.rawlog");
    ASSERT_EQ(
        runProgram("rawlog2rgbd", {"--input", folder / "o.rawlog", "--output", folder / "back"}).exit_code,
        0);
    const DatasetReader &from = simulated(), back = openDataset(folder / "back");
    ASSERT_EQ(back.size(), from.size());
    double depths = 0, missed = 0, differing = 0;
    for (std::size_t i = 0; i < from.size(); i++) {
        const RgbdFrame a = from.readFrame(i), b = back.readFrame(i);
        EXPECT_NEAR(a.timestamp - from.entry(0).timestamp, b.timestamp - back.entry(0).timestamp, 1.5e-6);
        if (GetParam().format != std::string("record3d")) {
            EXPECT_EQ(a.timestamp, b.timestamp) << "which counts from 0";
        }
        if (GetParam().frames != FolderKind::kOther) {
            EXPECT_EQ(cv::norm(a.colour, b.colour, cv::NORM_INF), 0) << i;
        }
        if (GetParam().frames == FolderKind::kSame) {
            EXPECT_EQ(cv::norm(a.depth, b.depth, cv::NORM_INF), 0) << i;
        }
        for (int v = 0; v < a.depth.rows; v++)
            for (int u = 0; u < a.depth.cols; u++) {
                const float wanted = a.depth.at<float>(v, u), there = b.depth.at<float>(v, u);
                depths += wanted > 0;
                missed += wanted > 0 && there == 0;
                differing += wanted > 0 && there > 0 && std::abs(wanted - there) > 0.05f * wanted;
            }
    }
    if (GetParam().frames == FolderKind::kOtherDepth) {
        EXPECT_LT(missed, 0.1 * depths) << "depth is registered, without holes";
        EXPECT_LT(differing, 0.1 * depths) << "and at the right place but for edges";
    }
}

TEST_P(FolderOfEveryKind, IsRecognisedWithItsTruth) {
    SCOPED_TRACE(GetParam().name);
    const TemporaryFolder folder;
    const auto arguments = GetParam().write(simulated(), folder / "input");
    const auto result = runProgram(
        "roevo-odometry", joined({"--input", folder / "input", "--output", folder / "out"}, arguments));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find(std::string(" (") + GetParam().format + ")"), std::string::npos) << result.out;
    std::smatch ate;
    ASSERT_TRUE(std::regex_search(result.out, ate, std::regex("ATE +([0-9.]+) cm"))) << result.out;
    EXPECT_LT(std::stod(ate.str(1)), 3) << result.out;
}

TEST(Inputs, ARawlogTellsWhatItHoldsToo) {
    const TemporaryFolder folder;
    rgbd2rawlog(folderKinds().back(), folder / "input", folder / "o.rawlog");
    const auto result =
        runProgram("roevo-odometry", {"--input", folder / "o.rawlog", "--output", folder / "out"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_TRUE(std::regex_search(result.out,
                                  std::regex("pairs of 160x120, fx [0-9.]+ fy [0-9.]+ cx [0-9.]+ cy [0-9.]+, "
                                             "30\\.0 Hz, fish-eye lens, median depth")))
        << result.out;
}

/// The table of docs/inputs.md: `--gtest_also_run_disabled_tests --gtest_filter=*FolderTable*`.
TEST(Inputs, DISABLED_FolderTable) {
    const TemporaryFolder folder;
    ASSERT_EQ(
        runProgram("rawlog-simulate", {"--scene", "shadows", "--frames", "90", "--noise", "kinect", "--size",
                                       "320x240", "--layout", "tum", "--output", folder / "walk"})
            .exit_code,
        0);
    const DatasetReader walk = openDataset(folder / "walk");
    std::string original;
    const auto row = [&](const std::string& what, const std::string& input,
                         const std::vector<std::string>& more) {
        const auto run =
            runProgram("roevo-odometry", joined({"--input", input, "--output", folder / "out"}, more));
        const std::string trajectory = run.exit_code == 0 ? readFile(folder / "out/trajectory.txt") : run.err;
        if (original.empty()) original = trajectory;
        std::smatch ate;
        std::regex_search(run.out, ate, std::regex("ATE +([0-9.]+) cm"));
        std::string options;
        for (const std::string& word : more) options += " " + word;
        std::printf("| %s | `%s` | %s | %s |\n", what.c_str(), options.c_str(), ate.str(1).c_str(),
                    trajectory == original ? "the same bytes" : "another");
        std::fflush(stdout);
    };
    row("the folder, TUM's layout", folder / "walk", {});
    for (const FolderKind& kind : folderKinds()) {
        const auto arguments = kind.write(walk, folder / "input");
        row(kind.name, folder / "input", arguments);
        fs::remove_all(folder / "input");
    }
}

}  // namespace
}  // namespace roevo
