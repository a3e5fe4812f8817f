// rawlog2rgbd: what it writes.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "roevo_mrpt/rawlog_writer.h"
#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::convertBack;
using test::countEntries;
using test::makeScan;
using test::patternColour;
using test::patternDepth;
using test::ProgramResult;
using test::readFile;
using test::sameImage;
using test::smallCamera;
using test::SmallTumFolder;

using test::scanAt;

TEST(Rawlog2rgbd, GivesTheFolderBack) {
    const SmallTumFolder input;
    input.write("groundtruth.txt", "# t\n1 0.123456789 0 0 0 0 0 1\n");
    input.write("accelerometer.txt", SmallTumFolder::stamp(1, 0.01) + " 0.1 -0.25 9.7512345678901\n");
    const test::TemporaryFolder output;
    for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--externalize-depth"}}) {
        fs::remove_all(output / "back");
        ASSERT_EQ(convert(input.path(), output / "o.rawlog", options).exit_code, 0);
        const ProgramResult outcome = convertBack(output / "o.rawlog", output / "back");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
        EXPECT_CONTAINS(outcome.out, "3 frames written, 0 left out, depth_scale 5000");
        EXPECT_CONTAINS(outcome.out, "3 files as they are, 0 written as PNG");
        EXPECT_CONTAINS(outcome.out, "frames/s; decoding the rawlog alone ");
        test::expectSameDataset(input.path(), output / "back");
        EXPECT_EQ(readFile(output / "back/groundtruth.txt"), "# t\n1 0.123456789 0 0 0 0 0 1\n");
        const auto imu = openDataset(output / "back").imu();
        ASSERT_EQ(imu.size(), 1u);
        EXPECT_EQ(imu[0].acceleration, Eigen::Vector3d(0.1, -0.25, 9.7512345678901));
        const std::string stamp = SmallTumFolder::stamp(0), depth_stamp = SmallTumFolder::stamp(0, 0.004);
        EXPECT_EQ(
            readFile(output / "back/associations.txt")
                .rfind(stamp + " rgb/" + stamp + ".png " + depth_stamp + " depth/" + depth_stamp + ".png\n",
                       0),
            0u);
        EXPECT_FALSE(fs::exists(output / "back.part"));
    }
}

TEST(Rawlog2rgbd, ColourFilesAreTheSameFiles) {
    const SmallTumFolder input;
    const test::TemporaryFolder output;
    ASSERT_EQ(convert(input.path(), output / "o.rawlog", {"--jpeg", "80"}).exit_code, 0);
    ASSERT_EQ(convertBack(output / "o.rawlog", output / "back").exit_code, 0);
    const std::string image = "rgb/" + SmallTumFolder::stamp(1) + ".jpg";
    struct stat a {
    }, b{};
    ASSERT_EQ(stat((output / ("back/" + image)).c_str(), &a), 0);
    ASSERT_EQ(stat((output / ("o_Images/RGBD_" + SmallTumFolder::stamp(1) + ".jpg")).c_str(), &b), 0);
    EXPECT_EQ(a.st_ino, b.st_ino) << "a hard link, on one disk";
    EXPECT_CONTAINS(readFile(output / "back/rgb.txt"), image);
}

TEST(Rawlog2rgbd, ImagesInsideTheRawlogBecomePng) {
    const test::TemporaryFolder folder;
    const cv::Mat colour = patternColour(smallCamera(), 1);
    cv::Mat grey;
    cv::extractChannel(colour, grey, 1);
    test::writeObjects(folder / "o.rawlog", {scanAt(0, colour), scanAt(1, grey)});
    const ProgramResult outcome = convertBack(folder / "o.rawlog", folder / "back");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "0 files as they are, 2 written as PNG");
    const DatasetReader back = openDataset(folder / "back");
    EXPECT_EQ(back.depthScale(), 10000);
    EXPECT_EQ(back.camera(), smallCamera());
    EXPECT_TRUE(sameImage(back.readImage(0), colour));
    EXPECT_TRUE(sameImage(back.readImage(1), grey));
    for (int i = 0; i < 2; i++)
        EXPECT_TRUE(sameImage(back.readDepth(static_cast<std::size_t>(i)), patternDepth(smallCamera(), i)));
}

TEST(Rawlog2rgbd, AnyRangeUnits) {
    const test::TemporaryFolder folder;
    const struct {
        float units;
        const char* scale;
    } cases[] = {
        {1.f / 5000, "5000"}, {0.001f, "1000"}, {0.0001f, "10000"}, {0.0003f, nullptr}, {1.f / 256, "256"}};
    for (const auto& each : cases) {
        auto scan = scanAt(0, patternColour(smallCamera(), 0));
        // Depths that make sense in any of these units
        cv::Mat depth(48, 64, CV_16UC1);
        for (int v = 0; v < 48; v++)
            for (int u = 0; u < 64; u++)
                depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>((2 + 0.01 * (u + v)) / each.units);
        std::memcpy(&scan->rangeImage(0, 0), depth.ptr(), depth.total() * 2);
        scan->rangeUnits = each.units;
        test::writeObjects(folder / "o.rawlog", {scan});
        fs::remove_all(folder / "back");
        const ProgramResult outcome = convertBack(folder / "o.rawlog", folder / "back");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
        const DatasetReader back = openDataset(folder / "back");
        EXPECT_TRUE(sameImage(back.readDepth(0), depth)) << each.units;
        EXPECT_EQ(back.depthUnit(), each.units) << "metres must not change either";
        if (each.scale != nullptr) {
            EXPECT_CONTAINS(readFile(folder / "back/camera.txt"),
                            std::string("depth_scale: ") + each.scale + " ");
        }
    }
}

TEST(Rawlog2rgbd, RangesAlongTheRayBecomeDepthAndItSaysSo) {
    const test::TemporaryFolder folder;
    const cv::Mat ranges(48, 64, CV_16UC1, cv::Scalar(2000));
    auto scan = makeScan(1000, smallCamera(), ranges, patternColour(smallCamera(), 0));
    scan->range_is_depth = false;
    test::writeObjects(folder / "o.rawlog", {scan});
    const ProgramResult outcome = convertBack(folder / "o.rawlog", folder / "back");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(
        outcome.out,
        "1 frame not as in the rawlog: ranges along the ray turned into depth, rounded to 1/1000 m");
    const cv::Mat depth = openDataset(folder / "back").readDepth(0);
    const PinholeCamera camera = smallCamera();
    for (const auto& [u, v] : {std::pair{0, 0}, {63, 47}, {31, 24}})
        EXPECT_NEAR(depth.at<std::uint16_t>(v, u), 2000 / camera.backProject(u, v, 1).norm(), 0.51);
}

TEST(Rawlog2rgbd, DifferingCamerasAreRegisteredAndItSaysSo) {
    const test::TemporaryFolder folder;
    auto scan = makeScan(1000, smallCamera(), cv::Mat(48, 64, CV_16UC1, cv::Scalar(1500)),
                         patternColour(smallCamera(), 0));
    PinholeCamera colour = smallCamera();
    colour.cx += 2;
    scan->cameraParamsIntensity = toMrptCamera(colour, "colour");
    test::writeObjects(folder / "o.rawlog", {scan});
    const ProgramResult outcome = convertBack(folder / "o.rawlog", folder / "back");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "depth registered to the colour camera, rounded to 1/1000 m");
    const DatasetReader back = openDataset(folder / "back");
    EXPECT_EQ(back.camera(), colour);
    EXPECT_EQ(back.readDepth(0).at<std::uint16_t>(20, 30), 1500);
}

TEST(Rawlog2rgbd, WhereTheSensorSitsIsNoted) {
    const test::TemporaryFolder folder;
    auto scan = makeScan(1000, smallCamera(), cv::Mat(48, 64, CV_16UC1, cv::Scalar(1500)),
                         patternColour(smallCamera(), 0));
    scan->sensorPose = mrpt::poses::CPose3D(0.25, 0, 0.5, 0, mrpt::DEG2RAD(30.0), 0);
    test::writeObjects(folder / "o.rawlog", {scan});
    ASSERT_EQ(convertBack(folder / "o.rawlog", folder / "back").exit_code, 0);
    EXPECT_CONTAINS(readFile(folder / "back/camera.txt"),
                    "sensor_on_robot_x_y_z_yaw_pitch_roll_deg: 0.25 0 0.5 0 30 0\n");
    EXPECT_EQ(openDataset(folder / "back").camera(), smallCamera()) << "readers pass over the note";
}

TEST(Rawlog2rgbd, BadFramesAreLeftOutWithTheirReason) {
    const test::TemporaryFolder folder;
    const cv::Mat colour = patternColour(smallCamera(), 0);
    auto other_units = scanAt(2, colour);
    other_units->rangeUnits = 0.002f;
    auto other_camera = scanAt(3, colour);
    other_camera->cameraParamsIntensity = other_camera->cameraParams =
        toMrptCamera(PinholeCamera{64, 48, 61, 61, 31, 23, {}}, "zoomed");
    auto lost = scanAt(4, colour);
    lost->intensityImage.setExternalStorage("lost.png");
    test::writeObjects(folder / "o.rawlog", {scanAt(5, colour), scanAt(1, colour), scanAt(1, colour),
                                             other_units, other_camera, lost, scanAt(0, colour)});
    const ProgramResult outcome = convertBack(folder / "o.rawlog", folder / "back");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "3 frames written, 4 left out");
    EXPECT_CONTAINS(outcome.out, "left out: frame at 1000.100000 s: its time stamp was there before");
    EXPECT_CONTAINS(outcome.out, "left out: frame at 1000.200000 s: its intrinsics, size or range units");
    EXPECT_CONTAINS(outcome.out, "left out: frame at 1000.300000 s: its intrinsics, size or range units");
    EXPECT_CONTAINS(outcome.out, "left out: frame at 1000.400000 s: image file not found: ");
    const DatasetReader back = openDataset(folder / "back");
    ASSERT_EQ(back.size(), 3u);
    EXPECT_TRUE(sameImage(back.readDepth(2), patternDepth(smallCamera(), 5))) << "in the order of time";
    const std::string list = readFile(folder / "back/rgb.txt");
    EXPECT_LT(list.find("\n1000.0"), list.find("\n1000.1"));
    EXPECT_LT(list.find("\n1000.1"), list.find("\n1000.5"));
}

}  // namespace
}  // namespace roevo
