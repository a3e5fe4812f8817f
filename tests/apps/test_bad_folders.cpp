// Dataset folders with something wrong in them: what cannot be used is said, and the rest goes on.
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <set>

#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::OdometryProgram;
using test::slidingRecording;

using BadFolder = OdometryProgram;

constexpr std::size_t kFrames = 8, kBad = 4;

TEST_F(BadFolder, MissingInputAndFoldersThatAreNoDataset) {
    expectError(run(folder_ / "none.rawlog"), 1, kName, {"none.rawlog", "no such file"});
    fs::create_directory(folder_ / "empty");
    expectError(run(folder_ / "empty"), 1, kName, {"empty", "rgb.txt"});
    EXPECT_FALSE(fs::exists(output()));
}

TEST_F(BadFolder, UnwritableOutput) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(2));
    test::writeFile(folder_ / "file", "");
    for (const std::string& place : {folder_ / "file", folder_ / "file/out"})
        expectError(test::runProgram(kName, {"--input", folder_ / "recording", "--output", place}), 1, kName,
                    {"cannot create the output folder", place});
}

TEST_F(BadFolder, NoIntrinsicsIsAnErrorAndNeverADefault) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(2));
    fs::remove(folder_ / "recording/camera.txt");
    expectError(run(folder_ / "recording"), 1, kName, {"intrinsics", "camera.txt"});
    test::writeFile(folder_ / "recording/camera.txt",
                    "width: 320\nheight: 240\nfx: 0\nfy: 300\ncx: 160\ncy: 120\ndepth_scale: 5000\n");
    expectError(run(folder_ / "recording"), 1, kName, {"camera.txt", "fx"});
}

TEST_F(BadFolder, ImpossibleDepthScaleIsNamedWithItsFactor) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(2));
    test::writeFile(folder_ / "recording/camera.txt", test::cameraText(5));  // 2.5 m become 2500 m
    expectError(run(folder_ / "recording"), 1, kName, {"depth", "5000"});
    test::writeFile(folder_ / "recording/camera.txt", test::cameraText(5e6));
    expectError(run(folder_ / "recording"), 1, kName, {"depth", "5000"});
}

TEST_F(BadFolder, BlackFrame) {
    auto frames = slidingRecording(kFrames);
    frames[kBad].colour.setTo(0);
    ASSERT_EQ(runFrames(frames).exit_code, 0);
    EXPECT_NE(status(kBad), "ok");
    EXPECT_NE(reason(kBad), "");
    expectOthersTracked(kBad, kFrames);
}

TEST_F(BadFolder, FrameWithoutDepth) {
    auto frames = slidingRecording(kFrames);
    frames[kBad].depth.setTo(0);
    ASSERT_EQ(runFrames(frames).exit_code, 0);
    // Its edges can still be tracked against the keyframe; if they are not, it says why.
    EXPECT_TRUE(status(kBad) == "ok" || !reason(kBad).empty());
    expectOthersTracked(kBad, kFrames);
    const auto poses = readTumTrajectory(output() + "/trajectory.txt");
    for (const auto& pose : poses) EXPECT_TRUE(pose.T_world_camera.isFinite());
}

TEST_F(BadFolder, FirstFramesWithoutDepth) {
    auto frames = slidingRecording(kFrames);
    frames[0].depth.setTo(0);
    frames[1].depth.setTo(0);
    ASSERT_EQ(runFrames(frames).exit_code, 0);
    EXPECT_NE(reason(0), "");
    EXPECT_EQ(status(2), "initialised");
    EXPECT_EQ(status(kFrames - 1), "ok");
}

TEST_F(BadFolder, NothingThatCanBeTracked) {
    auto frames = slidingRecording(kFrames);
    for (auto& frame : frames) frame.colour.setTo(0);
    expectError(runFrames(frames), 1, kName, {"none of the 8 frames could be tracked", "frames.csv"});
    EXPECT_EQ(rows().size(), kFrames) << "frames.csv is there to look into";
    EXPECT_FALSE(fs::exists(output() + "/trajectory.txt"));
    const std::string failure = summary()["failure"];
    EXPECT_NE(failure.find("none of the 8 frames could be tracked"), std::string::npos) << failure;
}

TEST_F(BadFolder, AFailedRunLeavesNoResultsOfAnEarlierOneBesideItsReport) {
    ASSERT_EQ(runFrames(slidingRecording(3)).exit_code, 0);
    EXPECT_EQ(summary()["failure"], "");
    EXPECT_TRUE(fs::exists(output() + "/map.3Dscene"));
    test::writeFile(output() + "/notes.txt", "the user's own\n");
    auto frames = slidingRecording(3);
    for (auto& frame : frames) frame.colour.setTo(0);
    EXPECT_EQ(runFrames(frames).exit_code, 1);
    std::set<std::string> left;
    for (const auto& entry : fs::directory_iterator(output())) left.insert(entry.path().filename().string());
    EXPECT_EQ(left, (std::set<std::string>{"config_used.ini", "frames.csv", "summary.json", "notes.txt"}));
}

TEST_F(BadFolder, ResultsThatCannotAllBeWrittenAreNotWrittenAtAll) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(3));
    fs::create_directories(output() + "/map.ply");
    expectError(run(folder_ / "recording"), 1, kName, {"map.ply", "it is a folder"});
    EXPECT_EQ(std::distance(fs::directory_iterator(output()), {}), 1) << "the folder that was in the way";
}

TEST_F(BadFolder, UnreadablePngInTheMiddle) {
    for (const std::string name : {"rgb", "depth"}) {
        test::writeTumFolder(folder_ / "recording", slidingRecording(kFrames));
        const std::string file = folder_ / ("recording/" + name + "/0004.png");
        fs::resize_file(file, 60);
        ASSERT_EQ(run(folder_ / "recording").exit_code, 0);
        EXPECT_EQ(status(kBad), "rejected");
        EXPECT_NE(reason(kBad).find("0004.png"), std::string::npos) << reason(kBad);
        expectOthersTracked(kBad, kFrames);
        EXPECT_EQ(summary()["frames"]["rejected"], 1);
    }
}

TEST_F(BadFolder, SizeThatChangesMidway) {
    auto frames = slidingRecording(kFrames);
    cv::resize(frames[kBad].colour, frames[kBad].colour, {160, 120});
    cv::resize(frames[kBad].depth, frames[kBad].depth, {160, 120}, 0, 0, cv::INTER_NEAREST);
    ASSERT_EQ(runFrames(frames).exit_code, 0);
    EXPECT_EQ(status(kBad), "rejected");
    EXPECT_NE(reason(kBad).find("160"), std::string::npos) << reason(kBad);
    expectOthersTracked(kBad, kFrames);
}

TEST_F(BadFolder, ListsWithRepeatedAndBackwardStamps) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(kFrames));
    for (const std::string list : {"/rgb.txt", "/depth.txt"}) {
        std::istringstream text(test::readFile(folder_ / "recording" + list));
        std::vector<std::string> lines;
        for (std::string line; std::getline(text, line);) lines.push_back(line + "\n");
        std::swap(lines[2], lines[5]);
        lines.push_back(lines[0]);
        std::string all;
        for (const std::string& line : lines) all += line;
        test::writeFile(folder_ / "recording" + list, all);
    }
    ASSERT_EQ(run(folder_ / "recording").exit_code, 0);
    ASSERT_EQ(rows().size(), kFrames);
    const auto poses = readTumTrajectory(output() + "/trajectory.txt");
    EXPECT_EQ(poses.size(), kFrames) << "sorted and unique";
}

TEST_F(BadFolder, GroundTruthThatDoesNotFit) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(4));
    expectError(run(folder_ / "recording", {"--ground-truth", folder_ / "none.txt"}), 1, kName, {"none.txt"});
    test::writeFile(
        folder_ / "late.txt",
        "5000 0 0 0 0 0 0 1\n5000.033333 0 0 0 0 0 0 1\n5000.066667 0 0 0 0 0 0 1\n5001 0 0 0 0 0 0 1\n");
    expectError(run(folder_ / "recording", {"--ground-truth", folder_ / "late.txt"}), 1, kName,
                {"late.txt", "4900", "5000"});
    EXPECT_TRUE(fs::exists(output() + "/trajectory.txt")) << "the run itself was good";
    // One that was only found beside the data does not spoil the run.
    fs::copy_file(folder_ / "late.txt", folder_ / "recording/groundtruth.txt",
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(run(folder_ / "recording").exit_code, 0);
    EXPECT_NE(summary()["ground_truth"]["fault"], nullptr);
}

}  // namespace
}  // namespace roevo
