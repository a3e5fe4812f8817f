#include <gtest/gtest.h>

#include "evaluation/trajectory_io.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::TemporaryFolder;
using test::writeFile;

// What reading a file with this text complains of.
std::string complaint(const std::string& text) {
    const TemporaryFolder folder;
    writeFile(folder / "t.txt", text);
    try {
        readTumTrajectory(folder / "t.txt");
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

TEST(TrajectoryIo, ReadsCommentsBlankLinesTabsAndCarriageReturns) {
    const TemporaryFolder folder;
    writeFile(folder / "t.txt",
              "\xEF\xBB\xBF# head\r\n\r\n  \n2.5 1 2 3 0 0 0 1\r\n1.25\t0 0 -1e-3 0 0 0.6 0.8 # turned\n+3 "
              "+0 0 0 0 0 0 1");
    const auto poses = readTumTrajectory(folder / "t.txt");
    ASSERT_EQ(poses.size(), 3u);
    EXPECT_EQ(poses[0].timestamp, 1.25) << "sorted";
    EXPECT_EQ(poses[0].T_world_camera.translation(), Eigen::Vector3d(0, 0, -1e-3));
    EXPECT_NEAR(poses[0].T_world_camera.linear()(1, 0), 2 * 0.6 * 0.8, 1e-15);
    EXPECT_EQ(poses[1].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(TrajectoryIo, OfRepeatedStampsTheLastCounts) {
    const TemporaryFolder folder;
    writeFile(folder / "t.txt", "1 0 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n2 6 0 0 0 0 0 1\n");
    const auto poses = readTumTrajectory(folder / "t.txt");
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[1].T_world_camera.translation().x(), 6);
}

TEST(TrajectoryIo, ErrorsNameFileAndLine) {
    const std::string good = "1 0 0 0 0 0 0 1\n";
    const auto expect = [](const std::string& text, const std::string& words) {
        EXPECT_NE(complaint(text).find(words), std::string::npos) << complaint(text);
    };
    expect(good + "2 0 0 0 0 0 1\n", "t.txt:2: expected 8 numbers");
    expect(good + "2 0 0 0 0 0 0 1 9\n", "found 9");
    expect(good + "\n2 0 0 x1 0 0 0 1\n", "t.txt:3: 'x1' is not a number");
    expect(good + "2 0 0 1,5 0 0 0 1\n", "'1,5' is not a number");
    expect(good + "2 0 nan 0 0 0 0 1\n", "t.txt:2: 'nan' is not finite");
    expect(good + "2 0 inf 0 0 0 0 1\n", "not finite");
    expect(good + "2 0 0 0 0 0 0 0\n", "t.txt:2: the quaternion has length 0");
    expect(good + "2 0 0 0 1 0 0 1\n", "length 1.41");
    expect(good + good + good, "t.txt: 2 of 3 rows repeat a time stamp: was it written with too few digits?");
    expect(good + "2 0 0 +-1 0 0 0 1\n", "'+-1' is not a number");
    expect("# nothing\n", "no pose");
    expect("", "no pose");
}

TEST(TrajectoryIo, MissingFileAndFolderAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW(readTumTrajectory(folder / "none.txt"), std::runtime_error);
    EXPECT_THROW(readTumTrajectory(folder.path().string()), std::runtime_error);
}

TEST(TrajectoryIo, WhatIsWrittenIsReadBack) {
    const TemporaryFolder folder;
    std::vector<StampedPose> poses;
    for (int i = 0; i < 50; ++i) {
        StampedPose pose;
        pose.timestamp = 1311868164.363181 + 0.033 * i;
        pose.T_world_camera = Eigen::Translation3d(0.1 * i, -2, 3e-4 * i) *
                              Eigen::AngleAxisd(0.13 * i, Eigen::Vector3d(1, 2, -1).normalized());
        poses.push_back(pose);
    }
    writeTumTrajectory(folder / "t.txt", poses);
    const auto back = readTumTrajectory(folder / "t.txt");
    ASSERT_EQ(back.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        EXPECT_NEAR(back[i].timestamp, poses[i].timestamp, 0.6e-6);
        EXPECT_LT((back[i].T_world_camera.matrix() - poses[i].T_world_camera.matrix()).norm(), 1e-8);
    }
}

TEST(TrajectoryIo, LinesHaveSixAndNineDecimals) {
    StampedPose pose;
    pose.timestamp = 12.5;
    pose.T_world_camera.translation() = Eigen::Vector3d(1, -2, 0.25);
    EXPECT_EQ(
        toTumLine(pose),
        "12.500000 1.000000000 -2.000000000 0.250000000 0.000000000 0.000000000 0.000000000 1.000000000");
}

}  // namespace
}  // namespace roevo
