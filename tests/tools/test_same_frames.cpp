// The same simulated frames through every layout: what comes out is the same, to the last bit.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "evaluation/trajectory_io.h"
#include "recordings/dataset_reader.h"
#include "roevo_simulator/simulator.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

constexpr int kFrames = 6;
// Not the published one, so that the ICL folder gets a camera.txt, too; 7-Scenes has one camera only.
const std::vector<std::string> kCamera = {"--size", "160x120", "--intrinsics", "120.25",
                                          "121.5",  "79.75",   "60.125"};

simulator::SimulationOptions options() {
    simulator::SimulationOptions o;
    o.scene = "shadows";
    o.width = 160, o.height = 120;
    o.intrinsics = {120.25, 121.5, 79.75, 60.125};
    o.frames = kFrames;
    o.speed = 2;
    o.useKinectNoise();
    return o;
}

void simulate(const std::string& layout, const std::string& output) {
    std::vector<std::string> arguments = {"--scene",  "shadows", "--frames", std::to_string(kFrames),
                                          "--noise",  "kinect",  "--speed",  "2",
                                          "--layout", layout,    "--output", output};
    arguments.insert(arguments.end(), kCamera.begin(), kCamera.end());
    const auto result = test::runProgram("rawlog-simulate", arguments);
    ASSERT_EQ(result.exit_code, 0) << result.all();
}

void expectTruth(const std::vector<StampedPose>& poses, const simulator::Simulator& truth) {
    ASSERT_EQ(poses.size(), static_cast<std::size_t>(kFrames));
    for (int i = 0; i < kFrames; i++) {
        const StampedPose& pose = poses[static_cast<std::size_t>(i)];
        EXPECT_NEAR(pose.timestamp, truth.timestamp(i), 5e-7);
        const Pose& exact = truth.poseAt(i / 30.);
        EXPECT_LT((pose.T_world_camera.translation() - exact.translation()).cwiseAbs().maxCoeff(), 1e-9);
        // The quaternion has nine decimals: half of the last one, in four terms, twice
        EXPECT_LT((pose.T_world_camera.linear() - exact.linear()).cwiseAbs().maxCoeff(), 4e-9);
        EXPECT_LT(Eigen::Quaterniond(pose.T_world_camera.linear()).coeffs().cwiseAbs().maxCoeff() -
                      Eigen::Quaterniond(exact.linear()).coeffs().cwiseAbs().maxCoeff(),
                  1e-9);
    }
}

class SameFrames : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Layouts, SameFrames, testing::Values("tum", "icl", "eth3d", "plain"),
                         [](const auto& info) { return info.param; });

TEST_P(SameFrames, ImagesTimesCameraAndPosesAreThoseOfTheSimulation) {
    const TemporaryFolder folder;
    const std::string path = folder / "dataset", rawlog = folder / "made.rawlog";
    simulate(GetParam(), path);
    const simulator::Simulator truth(options());
    const DatasetReader dataset = openDataset(path);
    EXPECT_EQ(dataset.description().format, GetParam());
    EXPECT_EQ(dataset.camera(), truth.camera());
    ASSERT_EQ(dataset.size(), static_cast<std::size_t>(kFrames));
    for (const int i : {0, kFrames - 1}) {
        const auto n = static_cast<std::size_t>(i);
        const simulator::SimulatedFrame frame = truth.frame(i);
        EXPECT_EQ(dataset.entry(n).timestamp, std::stod(std::to_string(frame.timestamp)));
        EXPECT_EQ(cv::norm(dataset.readDepth(n), simulator::quantiseDepth(frame.depth_noisy), cv::NORM_INF),
                  0);
        EXPECT_EQ(cv::norm(dataset.readImage(n), frame.colour, cv::NORM_INF), 0);
    }
    expectTruth(dataset.groundTruth().poses, truth);

    const auto converted = test::runProgram("rgbd2rawlog", {"--input", path, "--output", rawlog, "--verify"});
    ASSERT_EQ(converted.exit_code, 0) << converted.all();
    expectTruth(readTumTrajectory(folder / "made_groundtruth.txt"), truth);
}

TEST(SameFramesThroughAllLayouts, TrajectoriesHaveTheSameBytes) {
    const TemporaryFolder folder;
    std::string first;
    for (const std::string layout : {"rawlog", "tum", "icl", "eth3d", "plain"}) {
        const std::string input = folder / (layout == "rawlog" ? "room.rawlog" : layout),
                          output = folder / ("out_" + layout);
        simulate(layout, input);
        const auto run = test::runProgram("roevo-odometry", {"--input", input, "--output", output});
        ASSERT_EQ(run.exit_code, 0) << run.all();
        const std::string trajectory = test::readFile(output + "/trajectory.txt");
        EXPECT_NE(run.out.find("ATE"), std::string::npos) << "with ground truth: " << run.all();
        if (first.empty()) first = trajectory;
        EXPECT_FALSE(trajectory.empty());
        EXPECT_EQ(trajectory, first) << layout;
    }
}

TEST(SevenScenesAndItsRawlog, TrajectoriesHaveTheSameBytes) {
    const TemporaryFolder folder;
    const std::string input = folder / "seq-01", rawlog = folder / "made.rawlog";
    auto result = test::runProgram("rawlog-simulate", {"--scene", "livingroom", "--frames", "3", "--layout",
                                                       "7scenes", "--output", input});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    result = test::runProgram("rgbd2rawlog", {"--input", input, "--output", rawlog, "--verify"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    for (const auto& [from, to] : {std::pair(input, "a"), std::pair(rawlog, "b")}) {
        result = test::runProgram("roevo-odometry", {"--input", from, "--output", folder / to});
        ASSERT_EQ(result.exit_code, 0) << result.all();
    }
    EXPECT_EQ(test::readFile(folder / "a/trajectory.txt"), test::readFile(folder / "b/trajectory.txt"));
}

}  // namespace
}  // namespace roevo
