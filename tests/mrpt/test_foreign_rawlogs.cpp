// Scans as other programs write them: MRPT's converters and demos, grabbers, recordings that were moved.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/imgcodecs.hpp>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "recordings/frame_source.h"
#include "roevo_mrpt/camera_conversions.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "support/images.h"

namespace roevo {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using test::errorOf;
using test::same;

CObservation3DRangeScan::Ptr makeScan() {
    const PinholeCamera camera = test::smallCamera();
    return test::makeScan(1, camera, test::patternDepth(camera, 1), test::patternColour(camera, 1));
}

std::string faultOf(const CObservation3DRangeScan& scan) {
    return errorOf([&] { toRgbdFrame(scan); });
}

void expectContains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(ForeignRawlogs, RowsWrittenForColumns) {
    mrpt::img::TCamera camera;
    camera.ncols = 480, camera.nrows = 640;
    camera.setIntrinsicParamsFromValues(517.3, 516.5, 318.6, 255.3);  // fr1
    EXPECT_EQ(fromMrptCamera(camera, "camera").width, 640);
    EXPECT_EQ(fromMrptCamera(camera, "camera").height, 480);
    camera.setIntrinsicParamsFromValues(517.3, 516.5, 239.5, 319.5);  // of a phone that is held upright
    EXPECT_EQ(fromMrptCamera(camera, "camera").width, 480);
    camera.ncols = 640, camera.nrows = 480;
    camera.setIntrinsicParamsFromValues(517.3, 516.5, 400, 300);  // neither way
    EXPECT_EQ(fromMrptCamera(camera, "camera").width, 640);
}

TEST(ForeignRawlogs, NoPoseOfTheColourCameraMeansThatBothLookAlike) {
    auto scan = makeScan();
    const RgbdFrame there = toRgbdFrame(*scan);
    const Pose T_robot_camera = cameraOnRobot(*scan);
    scan->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D();
    EXPECT_TRUE(same(toRgbdFrame(*scan).depth, there.depth));
    EXPECT_TRUE(depthIsAsStored(*scan));
    EXPECT_TRUE(cameraOnRobot(*scan).isApprox(T_robot_camera, 1e-12));
    scan->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, 0.02, 0, 0, 0, 0);
    expectContains(faultOf(*scan), "turns the colour camera 90 degrees away from the depth camera");
}

TEST(ForeignRawlogs, DepthOfAnotherSizeThanItsCameras) {
    auto scan = makeScan();
    scan->cameraParams.cx(scan->cameraParams.ncols - 1.0);
    expectContains(faultOf(*scan), "its intrinsics are those of another image size");
    scan->cameraParamsIntensity = scan->cameraParams;
    EXPECT_EQ(faultOf(*scan), "") << "which a program warns of";
}

TEST(ForeignRawlogs, ScansBeforeTheFirstImage) {
    const test::TemporaryFolder folder;
    const auto write = [&](const std::string& name, int without, int with) {
        mrpt::io::CFileGZOutputStream file(folder / name);
        auto archive = mrpt::serialization::archiveFrom(file);
        for (int i = 0; i < without + with; ++i) {
            auto scan = makeScan();
            scan->timestamp += std::chrono::milliseconds(40 * i);
            if (i < without) {
                scan->hasIntensityImage = false;
                scan->cameraParamsIntensity = mrpt::img::TCamera();
            }
            archive << *scan;
        }
        archive << mrpt::obs::CObservationImage();
        return folder / name;
    };
    const auto source = openSource(write("some.rawlog", 2, 1));
    SourceFrame frame;
    ASSERT_TRUE(source->next(frame));
    EXPECT_EQ(frame.fault, "");
    EXPECT_FALSE(source->next(frame));
    std::string notes;
    for (const std::string& note : source->notes()) notes += note + "\n";
    expectContains(notes, "the first 2 scans, left out");
    const std::string none = write("none.rawlog", 3, 0);
    const std::string fault = errorOf([&] { openSource(none); });
    expectContains(fault, "none of its 3 scans has a colour image; its 1 CObservationImage");
    expectContains(fault, "rosbag2rawlog");
}

TEST(ForeignRawlogs, ImagesOfARecordingThatWasMoved) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "walk_Images");
    cv::imwrite(folder / "walk_Images/1.png", cv::Mat(makeScan()->intensityImage.asCvMatRef()));
    for (const char* before : {"/nowhere/walk_Images/1.png", "C:\\walk_Images\\1.png"}) {
        {
            mrpt::io::CFileGZOutputStream file(folder / "walk.rawlog");
            auto scan = makeScan();
            scan->intensityImage = mrpt::img::CImage();
            scan->intensityImage.setExternalStorage(before);
            mrpt::serialization::archiveFrom(file) << *scan;
        }
        RawlogReader reader(folder / "walk.rawlog");
        EXPECT_EQ(faultOf(*reader.next()), "") << before;
    }
}

TEST(ForeignRawlogs, ImagesOfMoreThanEightBits) {
    const test::TemporaryFolder folder;
    cv::Mat wide(48, 64, CV_16UC1);
    const auto write = [&](double most) {
        for (int v = 0; v < wide.rows; ++v)
            for (int u = 0; u < wide.cols; ++u)
                wide.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(most * u / 63);
        cv::imwrite(folder / "a.png", wide);
    };
    for (const double most : {1023., 4095.}) {
        write(most);
        expectContains(errorOf([&] { readColourFile(folder / "a.png"); }), "no more than 12 are used");
    }
    write(65535);
    const cv::Mat read = readColourFile(folder / "a.png");
    ASSERT_EQ(read.type(), CV_8UC1);
    EXPECT_EQ(read.at<std::uint8_t>(0, 0), 0);
    EXPECT_EQ(read.at<std::uint8_t>(5, 63), 255);
}

TEST(ForeignRawlogs, TwoCamerasUnderOneLabel) {
    const test::TemporaryFolder folder;
    for (const bool two : {false, true}) {
        {
            mrpt::io::CFileGZOutputStream file(folder / "two.rawlog");
            auto archive = mrpt::serialization::archiveFrom(file);
            for (int i = 0; i < 12; ++i) {
                auto scan = makeScan();
                scan->timestamp += std::chrono::milliseconds(40 * i);
                scan->setSensorPose(mrpt::poses::CPose3D(two ? 0.3 * (i % 2) : 0.01 * i, 0, 0, 0, 0, 0));
                archive << *scan;
            }
        }
        const auto source = openSource(folder / "two.rawlog");
        for (SourceFrame frame; source->next(frame);) EXPECT_EQ(frame.fault, "");
        EXPECT_EQ(source->warning().find("two cameras seem to share") != std::string::npos, two)
            << "one that is turned on the robot is none";
    }
}

TEST(ForeignRawlogs, PackedByAnotherProgram) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "a.rawlog",
                    "\xFD"
                    "7zXZ and more");
    expectContains(errorOf([&] { RawlogReader(folder / "a.rawlog"); }), "is packed by xz: unpack it first");
    test::writeFile(folder / "a.rawlog", "\x28\xB5\x2F\xFD and more");
    expectContains(errorOf([&] { RawlogReader(folder / "a.rawlog"); }), "is packed by zstd");
}

}  // namespace
}  // namespace roevo
