// Rawlogs as other programs and robots record them.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "programs/memory_peak.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "support/images.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using test::errorOf;
using test::makeScan;
using test::patternColour;
using test::patternDepth;
using test::same;
using test::smallCamera;

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

CObservation3DRangeScan::Ptr scanAt(int i, const std::string& label = "RGBD") {
    return makeScan(1000 + i, smallCamera(), patternDepth(smallCamera(), i), patternColour(smallCamera(), i),
                    label);
}

class OddRawlog : public ::testing::Test {
  protected:
    std::string write(const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) const {
        mrpt::io::CFileGZOutputStream stream(folder_ / "o.rawlog");
        auto archive = mrpt::serialization::archiveFrom(stream);
        for (const auto& object : objects) archive << *object;
        return folder_ / "o.rawlog";
    }

    static std::size_t count(RawlogReader& reader) {
        std::size_t scans = 0;
        while (reader.next()) scans++;
        return scans;
    }

    const test::TemporaryFolder folder_;
};

TEST_F(OddRawlog, SeveralSensorsInSensoryFrames) {
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    for (int i = 0; i < 3; i++) {
        auto frame = mrpt::obs::CSensoryFrame::Create();
        frame->insert(scanAt(i, "left"));
        frame->insert(scanAt(i, "right"));
        objects.push_back(mrpt::obs::CActionCollection::Create());
        objects.push_back(frame);
    }
    const std::string rawlog = write(objects);
    RawlogReader any(rawlog), right(rawlog, "right");
    EXPECT_CONTAINS(errorOf([&] { count(any); }), "(3 left, 3 right): choose one with --sensor-label");
    EXPECT_EQ(count(right), 3u);
}

TEST_F(OddRawlog, ASecondSensorThatTurnsUpLateIsLeftOutWithAWarning) {
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    for (int i = 0; i < 40; i++) objects.push_back(scanAt(i, "front"));
    objects.push_back(scanAt(40, "back"));
    objects.push_back(scanAt(41, "front"));
    const std::string rawlog = write(objects);
    RawlogReader reader(rawlog), chosen(rawlog, "front");
    EXPECT_EQ(count(reader), 41u);
    EXPECT_CONTAINS(reader.report().warning(), "1 back, 41 front");
    EXPECT_CONTAINS(reader.report().warning(), "--sensor-label");
    EXPECT_EQ(count(chosen), 41u);
    EXPECT_EQ(chosen.report().warning(), "") << "left out as asked";
}

TEST_F(OddRawlog, ASensorWithoutANameCanBeChosen) {
    const std::string rawlog = write({scanAt(0, ""), scanAt(0, "front"), scanAt(1, "")});
    RawlogReader any(rawlog), nameless(rawlog, "(no name)");
    EXPECT_CONTAINS(errorOf([&] { count(any); }), "2 (no name), 1 front");
    EXPECT_EQ(count(nameless), 2u);
}

TEST_F(OddRawlog, PointsWithoutARangeImageAreRefusedWithAdvice) {
    auto points = CObservation3DRangeScan::Create();
    points->sensorLabel = "LIDAR";
    points->hasPoints3D = true;
    points->resizePoints3DVectors(10);
    RawlogReader reader(write({points, points}));
    const std::string error = errorOf([&] { count(reader); });
    EXPECT_CONTAINS(error, "3D points");
    EXPECT_CONTAINS(error, "2 LIDAR");
    EXPECT_CONTAINS(error, "record again with range images");

    RawlogReader mixed(write({points, scanAt(0), points}));
    EXPECT_EQ(count(mixed), 1u);
    EXPECT_CONTAINS(mixed.report().warning(),
                    "2 scan(s) with 3D points but no range image left out (2 LIDAR)");
}

TEST_F(OddRawlog, DepthFilesThatAreMissingOrDamagedConcernTheirFrameOnly) {
    fs::create_directory(folder_ / "o_Images");
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    for (int i = 0; i < 5; i++) {
        auto scan = scanAt(i);
        scan->rangeImage_convertToExternalStorage("d" + std::to_string(i) + ".bin", folder_ / "o_Images/");
        objects.push_back(scan);
    }
    const auto half = static_cast<std::streamoff>(fs::file_size(folder_ / "o_Images/d2.bin") / 2);
    fs::remove(folder_ / "o_Images/d1.bin");
    fs::resize_file(folder_ / "o_Images/d2.bin", static_cast<std::uintmax_t>(half));
    std::fstream(folder_ / "o_Images/d3.bin", std::ios::in | std::ios::out | std::ios::binary).seekp(half)
        << "??";
    const std::string expected[] = {"", "range image file not found: " + (folder_ / "o_Images/d1.bin"),
                                    "cannot read range image (damaged): " + (folder_ / "o_Images/d2.bin"),
                                    "cannot read range image (damaged): " + (folder_ / "o_Images/d3.bin"),
                                    ""};
    RawlogReader reader(write(objects));
    for (int i = 0; i < 5; i++) {
        const auto scan = reader.next();
        ASSERT_TRUE(scan);
        EXPECT_EQ(errorOf([&] { toRgbdFrame(*scan); }), expected[i]);
        if (!expected[i].empty()) continue;
        const auto value = patternDepth(smallCamera(), i).at<std::uint16_t>(9, 9);
        EXPECT_EQ(toRgbdFrame(*scan).depth.at<float>(9, 9), value * 0.001f);
    }
    EXPECT_FALSE(reader.next());
}

TEST_F(OddRawlog, DepthInTextFiles) {
    fs::create_directory(folder_ / "o_Images");
    auto scan = scanAt(0);
    CObservation3DRangeScan::EXTERNALS_AS_TEXT(true);
    scan->rangeImage_convertToExternalStorage("d.txt", folder_ / "o_Images/");
    CObservation3DRangeScan::EXTERNALS_AS_TEXT(false);
    RawlogReader reader(write({scan}));
    EXPECT_EQ(toRgbdFrame(*reader.next()).depth.at<float>(9, 9),
              patternDepth(smallCamera(), 0).at<std::uint16_t>(9, 9) * 0.001f);
}

TEST_F(OddRawlog, LostPointFilesDoNotMatterWhereThereIsARangeImage) {
    fs::create_directory(folder_ / "o_Images");
    auto scan = scanAt(0);
    scan->hasPoints3D = true;
    scan->resizePoints3DVectors(10);
    scan->points3D_convertToExternalStorage("p.bin", folder_ / "o_Images/");
    scan->rangeImage_convertToExternalStorage("d.bin", folder_ / "o_Images/");
    const std::string rawlog = write({scan});
    fs::remove(folder_ / "o_Images/p.bin");
    RawlogReader reader(rawlog);
    EXPECT_EQ(errorOf([&] { toRgbdFrame(*reader.next()); }), "");
}

TEST_F(OddRawlog, ImagesBesideTheRawlogAreFound) {
    // Older recordings keep them without a folder of their own
    auto scan = scanAt(0);
    cv::imwrite(folder_ / "beside.png", patternColour(smallCamera(), 0));
    scan->intensityImage.setExternalStorage("beside.png");
    scan->rangeImage_convertToExternalStorage("beside.bin", (folder_.path() / "").string());
    RawlogReader reader(write({scan}));
    const RgbdFrame frame = toRgbdFrame(*reader.next());
    EXPECT_TRUE(same(frame.colour, patternColour(smallCamera(), 0)));
    EXPECT_EQ(frame.depth.at<float>(9, 9), patternDepth(smallCamera(), 0).at<std::uint16_t>(9, 9) * 0.001f);
}

TEST_F(OddRawlog, FlagsOfADamagedFileAreTrueOrFalse) {
    const auto scan = scanAt(0);
    scan->range_is_depth = true;
    std::string bytes = test::bytesOf(*scan);
    scan->range_is_depth = false;
    const std::string other = test::bytesOf(*scan);
    const auto flag = std::mismatch(bytes.begin(), bytes.end(), other.begin()).first;
    ASSERT_NE(flag, bytes.end());
    *flag = 96;
    test::writeFile(folder_ / "o.rawlog", bytes);
    RawlogReader reader(folder_ / "o.rawlog");
    const auto read = reader.next();
    ASSERT_TRUE(read);
    unsigned char byte = 0;
    std::memcpy(&byte, &read->range_is_depth, sizeof byte);
    EXPECT_EQ(byte, 1) << "C++ knows only true and false";
}

TEST_F(OddRawlog, ATextIsNoLongerThanTheFileWhateverItsLengthSays) {
    const std::string good = test::bytesOf(*scanAt(0, "a label like no other"));
    const std::size_t label = good.find("a label like no other");
    ASSERT_NE(label, std::string::npos);
    for (const std::uint32_t length : {400u << 20, 0xfffffff0u}) {
        std::string bad = good;
        std::memcpy(&bad[label - sizeof length], &length, sizeof length);
        test::writeFile(folder_ / "o.rawlog", good + bad);
        const double before = memoryPeakMb();
        RawlogReader reader(folder_ / "o.rawlog");
        EXPECT_EQ(count(reader), 1u);
        EXPECT_CONTAINS(reader.report().fault, "entry 2");
        EXPECT_LT(memoryPeakMb() - before, 100) << "MB; room for a text that is not there";
    }
}

TEST_F(OddRawlog, AnUnknownClassIsNamed) {
    std::string bytes = test::bytesOf(*scanAt(0));
    std::string unknown = test::bytesOf(mrpt::obs::CObservationIMU());
    const std::string known = "CObservationIMU";
    unknown.replace(unknown.find(known), known.size(), "CObservationGAS");
    test::writeFile(folder_ / "o.rawlog", bytes + unknown + bytes);
    RawlogReader reader(folder_ / "o.rawlog");
    EXPECT_EQ(count(reader), 1u);
    EXPECT_CONTAINS(reader.report().fault,
                    "holds an unknown class ('mrpt::obs::CObservationGAS'): reading stopped at entry 2");
}

TEST_F(OddRawlog, OtherObservationsAreShownInTheOrderOfTheFile) {
    auto imu = mrpt::obs::CObservationIMU::Create();
    std::string order;
    RawlogReader reader(write({imu, scanAt(0), imu, imu, scanAt(1), imu}));
    reader.onOther([&](const mrpt::obs::CObservation& observation) {
        order += dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation) != nullptr ? 'i' : '?';
    });
    while (reader.next()) order += 's';
    EXPECT_EQ(order, "isiisi");
}

TEST(OddScan, ChannelOrderOfTheImage) {
    const cv::Mat bgr = patternColour(smallCamera(), 1);
    auto scan = scanAt(1);
    cv::Mat bgra;
    cv::cvtColor(bgr, bgra, cv::COLOR_BGR2BGRA);
    scan->intensityImage = mrpt::img::CImage(bgra, mrpt::img::DEEP_COPY);
    for (int time = 0; time < 2; time++) {  // converting must not change the scan
        const RgbdFrame frame = toRgbdFrame(*scan);
        EXPECT_TRUE(same(frame.colour, bgr)) << time;
        EXPECT_TRUE(same(frame.grey, toRgbdFrame(*scanAt(1)).grey)) << time;
    }
}

TEST(OddScan, WhetherDepthIsAsStored) {
    auto scan = scanAt(0);
    EXPECT_TRUE(depthIsAsStored(*scan));
    scan->range_is_depth = false;
    EXPECT_FALSE(depthIsAsStored(*scan));
    scan = scanAt(0);
    scan->cameraParamsIntensity.cx(scan->cameraParamsIntensity.cx() + 1);
    EXPECT_FALSE(depthIsAsStored(*scan));
    scan = scanAt(0);
    scan->relativePoseIntensityWRTDepth.x(0.03);
    EXPECT_FALSE(depthIsAsStored(*scan));
}

TEST(SensorOnRobot, TheOpticalAxesSitWhereMrptPutsThem) {
    auto scan = scanAt(0);
    EXPECT_FALSE(isMountedOnRobot(*scan));
    scan->sensorPose = mrpt::poses::CPose3D(0.2, -0.1, 1.5, 0, mrpt::DEG2RAD(90.0), 0);  // looks at the floor
    EXPECT_TRUE(isMountedOnRobot(*scan));
    const Pose T_robot_camera = cameraOnRobot(*scan);
    // A point one metre before the lens is one metre below the sensor; one to the right is to the robot's
    // right
    EXPECT_TRUE((T_robot_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(0.2, -0.1, 0.5), 1e-12));
    EXPECT_TRUE((T_robot_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0.2, -1.1, 1.5), 1e-12));
}

TEST(SensorOnRobot, TheRobotTurnsOnTheSpot) {
    auto scan = scanAt(0);
    scan->sensorPose = mrpt::poses::CPose3D(0.3, 0.1, 1.2, 0.4, 0.2, -0.1);
    const Pose T_robot_camera = cameraOnRobot(*scan);
    std::vector<StampedPose> camera;
    for (int i = 0; i <= 10; i++) {
        Pose T_start_robot = Pose::Identity();
        T_start_robot.setRotation(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix());
        camera.push_back({0.1 * i, T_robot_camera.inverse() * T_start_robot * T_robot_camera});
    }
    EXPECT_GT(camera.back().T_world_camera.translation().norm(), 0.2) << "the camera swings";
    const auto robot = robotTrajectory(camera, {{0, T_robot_camera}});
    ASSERT_EQ(robot.size(), camera.size());
    for (int i = 0; i <= 10; i++) {
        const auto& pose = robot[static_cast<std::size_t>(i)];
        EXPECT_EQ(pose.timestamp, 0.1 * i);
        EXPECT_LT(pose.T_world_camera.translation().norm(), 1e-12);
        EXPECT_NEAR(Eigen::AngleAxisd(pose.T_world_camera.linear()).angle(), 0.1 * i, 1e-12);
        EXPECT_GE(pose.T_world_camera.linear()(1, 0), -1e-12) << "to the left, as the robot did";
    }
}

TEST(SensorOnRobot, AHeadThatPansOnAStandingRobot) {
    std::vector<StampedPose> camera, mounts;
    for (int i = 0; i <= 5; i++) {
        auto scan = scanAt(i);
        scan->sensorPose = mrpt::poses::CPose3D(0.3, 0, 1.2, 0.1 * i, 0, 0);
        mounts.push_back({0.1 * i, cameraOnRobot(*scan)});
        camera.push_back({0.1 * i, mounts.front().T_world_camera.inverse() * mounts.back().T_world_camera});
    }
    mounts.erase(mounts.begin() +
                 3);  // a frame without a pose has no mount; its neighbours still have theirs
    camera.erase(camera.begin() + 3);
    for (const StampedPose& pose : robotTrajectory(camera, mounts))
        EXPECT_TRUE(pose.T_world_camera.isApprox(Pose::Identity(), 1e-12)) << pose.timestamp;
}

}  // namespace
}  // namespace roevo
