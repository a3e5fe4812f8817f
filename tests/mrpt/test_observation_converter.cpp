#include <gtest/gtest.h>
#include <mrpt/maps/CColouredPointsMap.h>

#include <cmath>
#include <filesystem>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

using test::errorOf;
using test::makeScan;
using test::patternColour;
using test::patternDepth;
using test::smallCamera;

const char* const kKinectRawlog = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";

cv::Mat flatDepth(const PinholeCamera& camera, int value) {
    return cv::Mat(camera.height, camera.width, CV_16UC1, cv::Scalar(value));
}

TEST(ObservationConverter, RangeUnitsScaleTheDepth) {
    const PinholeCamera camera = smallCamera();
    auto scan = makeScan(1, camera, flatDepth(camera, 1234), patternColour(camera, 0));
    scan->rangeUnits = 0.0002f;
    EXPECT_EQ(toRgbdFrame(*scan).depth.at<float>(7, 7), 1234 * 0.0002f);
    scan->rangeUnits = 0;
    EXPECT_NE(errorOf([&] { toRgbdFrame(*scan); }).find("rangeUnits"), std::string::npos);
}

TEST(ObservationConverter, RangesAlongTheRayBecomeDepths) {
    const PinholeCamera camera = smallCamera();
    auto scan = makeScan(1, camera, flatDepth(camera, 2000), patternColour(camera, 0));
    scan->range_is_depth = false;
    const cv::Mat depth = toRgbdFrame(*scan).depth;
    for (int v = 0; v < camera.height; v += 7)
        for (int u = 0; u < camera.width; u += 7)
            EXPECT_NEAR(camera.backProject(u, v, depth.at<float>(v, u)).norm(), 2.0, 1e-5);
}

TEST(ObservationConverter, GreyAndColourImages) {
    const PinholeCamera camera = smallCamera();
    const cv::Mat colour = patternColour(camera, 3);
    const RgbdFrame from_colour = toRgbdFrame(*makeScan(1, camera, flatDepth(camera, 1000), colour));
    EXPECT_EQ(cv::norm(from_colour.colour, colour, cv::NORM_INF), 0);
    const auto bgr = colour.at<cv::Vec3b>(5, 6);
    EXPECT_NEAR(from_colour.grey.at<std::uint8_t>(5, 6), 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2], 1);
    const RgbdFrame from_grey = toRgbdFrame(*makeScan(1, camera, flatDepth(camera, 1000), from_colour.grey));
    EXPECT_EQ(cv::norm(from_grey.grey, from_colour.grey, cv::NORM_INF), 0);
    EXPECT_TRUE(from_grey.colour.empty());
}

TEST(ObservationConverter, CoincidingCamerasAreNotResampledAndKeepTheirDistortion) {
    PinholeCamera camera = smallCamera();
    camera.distortion = {0.26, -0.95, -0.005, 0.003, 1.16};
    const cv::Mat raw = patternDepth(camera, 5);
    const auto scan = makeScan(1, camera, raw, patternColour(camera, 0));
    const cv::Mat depth = toRgbdFrame(*scan).depth;
    for (int v = 0; v < raw.rows; v++)
        for (int u = 0; u < raw.cols; u++)
            ASSERT_EQ(depth.at<float>(v, u), raw.at<std::uint16_t>(v, u) * 0.001f);
    EXPECT_EQ(colourCameraOf(*scan), camera);
}

TEST(ObservationConverter, ErrorsAreOneLineThatNamesTheFault) {
    const PinholeCamera camera = smallCamera();
    const auto good = makeScan(1, camera, flatDepth(camera, 1000), patternColour(camera, 0));
    const auto error = [&](const std::function<void(mrpt::obs::CObservation3DRangeScan&)>& spoil) {
        mrpt::obs::CObservation3DRangeScan scan = *good;
        spoil(scan);
        const std::string text = errorOf([&] { toRgbdFrame(scan); });
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text;
    };
    EXPECT_EQ(error([](auto&) {}), "");
    EXPECT_NE(error([](auto& s) { s.cameraParamsIntensity = {}; }).find("no intrinsics: the colour camera"),
              std::string::npos);
    EXPECT_NE(error([](auto& s) { s.cameraParams = {}; }).find("no intrinsics: the depth camera"),
              std::string::npos);
    EXPECT_NE(error([](auto& s) { s.hasIntensityImage = false; }).find("no colour or grey image"),
              std::string::npos);
    EXPECT_NE(error([](auto& s) { s.hasRangeImage = false; }).find("no range image"), std::string::npos);
    EXPECT_NE(error([](auto& s) { s.cameraParamsIntensity.ncols = 640; }).find("64x48"), std::string::npos);
    EXPECT_NE(error([](auto& s) { s.cameraParams.nrows = 99; }).find("range image is 64x48"),
              std::string::npos);
    EXPECT_NE(error([](auto& s) {
                  s.intensityImage.setExternalStorage("/nowhere/lost.png");
              }).find("/nowhere/lost.png"),
              std::string::npos);
}

/// Colours the depth image's points as MRPT does, from an image that holds each pixel's own coordinates, and
/// asks whether our registered depth is the depth of the same point at the same pixel.
void expectSameRegistrationAsMrpt(mrpt::obs::CObservation3DRangeScan scan, double least_share) {
    const PinholeCamera colour_camera = colourCameraOf(scan);
    const cv::Mat ours = toRgbdFrame(scan).depth;
    cv::Mat coordinates(colour_camera.height, colour_camera.width, CV_8UC3);
    for (int v = 0; v < coordinates.rows; v++)
        for (int u = 0; u < coordinates.cols; u++)
            coordinates.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(u % 256),
                                               static_cast<std::uint8_t>(v % 256),
                                               static_cast<std::uint8_t>(u / 256 + 16 * (v / 256))};
    scan.intensityImage = mrpt::img::CImage(coordinates, mrpt::img::DEEP_COPY);
    mrpt::maps::CColouredPointsMap cloud;
    cloud.colorScheme.scheme = mrpt::maps::CColouredPointsMap::cmFromIntensityImage;
    mrpt::obs::T3DPointsProjectionParams parameters;
    parameters.onlyPointsWithIntensityColor = true;
    scan.unprojectInto(cloud, parameters);

    const Pose T_colour_sensor = toEigen(scan.relativePoseIntensityWRTDepth).inverse();
    std::size_t compared = 0, agreeing = 0;
    for (std::size_t i = 0; i < cloud.size(); i++) {
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        cloud.getPointRGB(i, x, y, z, r, g, b);
        if (x == 0 && y == 0 && z == 0) continue;
        const int high = static_cast<int>(std::lround(r * 255));
        const int u = static_cast<int>(std::lround(b * 255)) + 256 * (high % 16);
        const int v = static_cast<int>(std::lround(g * 255)) + 256 * (high / 16);
        const double depth = (T_colour_sensor * Eigen::Vector3d(x, y, z)).z();
        compared++;
        if (std::abs(ours.at<float>(v, u) - depth) < 0.01 * depth) agreeing++;
    }
    ASSERT_GT(compared, ours.total() / 3);
    EXPECT_GT(static_cast<double>(agreeing), least_share * static_cast<double>(compared));
}

TEST(ObservationConverter, DifferingCamerasAreRegisteredAsMrptDoes) {
    PinholeCamera depth_camera = smallCamera(), colour_camera = smallCamera();
    colour_camera.width = 96;
    colour_camera.height = 72;
    colour_camera.fx = 85;
    colour_camera.fy = 86;
    colour_camera.cx = 50;
    colour_camera.cy = 33;
    cv::Mat depth = flatDepth(depth_camera, 2000);
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++)
            depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1500 + 9 * u + 4 * v);
    auto scan = makeScan(1, depth_camera, depth, patternColour(colour_camera, 0));
    scan->cameraParamsIntensity = toMrptCamera(colour_camera, "colour");
    Pose T_sensor_colour = sensorFromOptical();
    T_sensor_colour.translation() << 0.01, -0.12, 0.04;  // enough to tell a direction from its inverse
    T_sensor_colour.setRotation(T_sensor_colour.linear() *
                                Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix());
    scan->relativePoseIntensityWRTDepth = toMrpt(T_sensor_colour);
    expectSameRegistrationAsMrpt(*scan, 0.97);
}

TEST(ObservationConverter, ReadsTheKinectRawlogThatMrptShips) {
    if (!std::filesystem::exists(kKinectRawlog))
        GTEST_SKIP() << kKinectRawlog << " (package mrpt-common) not installed";
    RawlogReader reader(kKinectRawlog);
    const auto scan = reader.next();
    ASSERT_TRUE(scan);
    EXPECT_NE(fromMrptCamera(scan->cameraParams, "depth"), colourCameraOf(*scan));
    const RgbdFrame frame = toRgbdFrame(*scan);
    EXPECT_EQ(frame.depth.size(), cv::Size(640, 480));
    EXPECT_EQ(frame.grey.size(), cv::Size(640, 480));
    EXPECT_GT(cv::countNonZero(frame.depth), 640 * 480 / 2);
    double farthest = 0;
    cv::minMaxLoc(frame.depth, nullptr, &farthest);
    EXPECT_GT(farthest, 2);
    EXPECT_LT(farthest, 3);
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.report().warning(), "");
    scan->cameraParamsIntensity.distortion =
        mrpt::img::DistortionModel::none;  // MRPT leaves the colour lens out
    expectSameRegistrationAsMrpt(*scan, 0.95);
}

TEST(ObservationConverter, APoseOfTheColourCameraIsTheStoredOneToTheLastBit) {
    const test::TemporaryFolder folder;
    const PinholeCamera camera = smallCamera();
    int changed = 0;
    for (int i = 0; i < 10; i++) {
        Pose T_depth_colour(Eigen::Translation3d(0.01 * i, -0.02, 0.003 * i) *
                            Eigen::AngleAxisd(0.1 + 0.3 * i, Eigen::Vector3d(1, i, -0.5).normalized()));
        RawlogWriterOptions options;
        options.depth_camera = DepthCamera{camera, T_depth_colour};
        const std::string rawlog = folder / (std::to_string(i) + ".rawlog");
        RawlogWriter writer(rawlog, camera, options);
        writer.add(1, flatDepth(camera, 2000), patternColour(camera, 0));
        writer.finish();
        RawlogReader reader(rawlog);
        const Pose read = colourFromDepth(reader.next()->relativePoseIntensityWRTDepth);
        EXPECT_EQ((colourFromDepthAsStored(T_depth_colour).matrix() - read.matrix()).norm(), 0) << i;
        EXPECT_LT((T_depth_colour.inverse().matrix() - read.matrix()).norm(), 1e-14);
        if (T_depth_colour.inverse().matrix() != read.matrix()) changed++;
    }
    EXPECT_GT(changed, 0) << "or there is nothing to it";
}

}  // namespace
}  // namespace roevo
