// rawlog2rgbd: what it refuses, in one line and with nothing left behind.
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::convertBack;
using test::countEntries;
using test::expectError;
using test::ProgramResult;
using test::scanAt;
using test::SmallTumFolder;

constexpr char kName[] = "rawlog2rgbd";

class Rawlog2rgbdErrors : public ::testing::Test {
  protected:
    ProgramResult run(const std::string& input, const std::vector<std::string>& more = {}) const {
        return convertBack(folder_ / input, folder_ / "back", more);
    }
    void expectNothingWritten() const {
        EXPECT_FALSE(fs::exists(folder_ / "back"));
        EXPECT_FALSE(fs::exists(folder_ / "back.part"));
    }
    test::TemporaryFolder folder_;
};

TEST_F(Rawlog2rgbdErrors, Usage) {
    EXPECT_EQ(test::runProgram(kName, {"--help"}).exit_code, 0);
    EXPECT_CONTAINS(test::runProgram(kName, {"--help"}).out, "Example");
    EXPECT_CONTAINS(test::runProgram(kName, {"--version"}).out, "rawlog2rgbd ");
    expectError(test::runProgram(kName, {}), 2, kName, {"required"});
    expectError(run("o.rawlog", {"--depth"}), 2, kName, {"--depth"});
}

TEST_F(Rawlog2rgbdErrors, InputsThatAreNoRecording) {
    test::writeFile(folder_ / "text.rawlog", "this is text\n");
    test::writeFile(folder_ / "empty.rawlog", "");
    test::writeObjects(folder_ / "laser.rawlog", {mrpt::obs::CObservation2DRangeScan::Create()});
    auto points = scanAt(0, "LIDAR");
    points->hasRangeImage = false;
    points->hasPoints3D = true;
    test::writeObjects(folder_ / "points.rawlog", {points, points});
    expectError(run("none.rawlog"), 1, kName, {"none.rawlog", "not found"});
    expectError(run(""), 1, kName, {"folder"});
    expectError(run("text.rawlog"), 1, kName, {"text.rawlog", "not a rawlog"});
    expectError(run("empty.rawlog"), 1, kName, {"empty.rawlog", "empty"});
    expectError(run("laser.rawlog"), 1, kName, {"laser.rawlog", "1 mrpt::obs::CObservation2DRangeScan"});
    expectError(run("points.rawlog"), 1, kName, {"3D points", "2 LIDAR", "grab_depth"});
    expectNothingWritten();
}

TEST_F(Rawlog2rgbdErrors, NoUsableFrame) {
    auto lost = scanAt(0), dark = scanAt(1);
    lost->intensityImage.setExternalStorage("lost.png");
    dark->hasIntensityImage = false;
    test::writeObjects(folder_ / "o.rawlog", {lost, dark});
    expectError(run("o.rawlog"), 1, kName, {"o.rawlog", "none of its 2 frames", "lost.png"});
    expectNothingWritten();
}

TEST_F(Rawlog2rgbdErrors, ScansWithoutATimeStampAreLeftOut) {
    auto first = scanAt(0), third = scanAt(2);
    first->timestamp = third->timestamp = INVALID_TIMESTAMP;
    test::writeObjects(folder_ / "o.rawlog", {first, scanAt(1), third});
    const ProgramResult outcome = run("o.rawlog");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "1 frame written, 2 left out");
    EXPECT_CONTAINS(outcome.all(), "frame 1: it has no time stamp");
    EXPECT_CONTAINS(outcome.all(), "frame 3: it has no time stamp");
    EXPECT_EQ(test::readFile(folder_ / "back/rgb.txt").find("11644473600"), std::string::npos);
}

TEST_F(Rawlog2rgbdErrors, SeveralSensors) {
    test::writeObjects(folder_ / "o.rawlog", {scanAt(0, "left"), scanAt(0, "right"), scanAt(1, "left")});
    expectError(run("o.rawlog"), 1, kName, {"2 left, 1 right", "--sensor-label"});
    expectError(run("o.rawlog", {"--sensor-label", "top"}), 1, kName, {"top", "2 left, 1 right"});
    expectNothingWritten();
    const ProgramResult outcome = run("o.rawlog", {"--sensor-label", "right"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "1 frame written");
}

TEST_F(Rawlog2rgbdErrors, Outputs) {
    test::writeObjects(folder_ / "o.rawlog", {scanAt(0)});
    fs::create_directory(folder_ / "full");
    test::writeFile(folder_ / "full/precious.txt", "mine");
    const auto to = [&](const std::string& output) { return convertBack(folder_ / "o.rawlog", output); };
    expectError(to(folder_ / "full"), 1, kName, {"full", "not empty"});
    EXPECT_EQ(test::readFile(folder_ / "full/precious.txt"), "mine");
    expectError(to(folder_ / "full/precious.txt"), 1, kName, {"precious.txt", "exists"});
    expectError(to(folder_ / "none/back"), 1, kName, {"none/back", "No such file"});
    expectError(to("/sys/back"), 1, kName, {"/sys/back"});
    EXPECT_EQ(countEntries(folder_.path()), 2);
    fs::create_directory(folder_ / "empty");
    EXPECT_EQ(to(folder_ / "empty/").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "empty/camera.txt"));
}

TEST_F(Rawlog2rgbdErrors, AFolderInTheWayOfTheGroundTruthIsNotTakenForOne) {
    test::writeObjects(folder_ / "o.rawlog", {scanAt(0)});
    fs::create_directory(folder_ / "o_groundtruth.txt");
    EXPECT_EQ(run("o.rawlog").exit_code, 0);
    EXPECT_FALSE(fs::exists(folder_ / "back/groundtruth.txt"));
}

TEST_F(Rawlog2rgbdErrors, TruncatedIsReportedAndUsedAsFarAsItGoes) {
    test::writeObjects(folder_ / "o.rawlog", {scanAt(0), scanAt(1), scanAt(2), scanAt(3)});
    fs::resize_file(folder_ / "o.rawlog", fs::file_size(folder_ / "o.rawlog") * 6 / 10);
    const ProgramResult outcome = run("o.rawlog");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.err, "rawlog2rgbd: warning: ");
    EXPECT_CONTAINS(outcome.err, "truncated");
    EXPECT_EQ(openDataset(folder_ / "back").size(), 2u);
}

TEST_F(Rawlog2rgbdErrors, PathsWithSpacesAndLetters) {
    fs::create_directory(folder_ / "Küche 1");
    test::writeObjects(folder_ / "Küche 1/été 2.rawlog", {scanAt(0)});
    const ProgramResult outcome = convertBack(folder_ / "Küche 1/été 2.rawlog", folder_ / "Küche 1/zurück ");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_EQ(openDataset(folder_ / "Küche 1/zurück ").size(), 1u);
}

}  // namespace
}  // namespace roevo
