// The maps of CRoevoOdometry, and beginning with one.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "mrpt/kinect_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

using mrpt::poses::CPose3D;
using test::errorOf;
using test::laterScan;

using RoevoOdometryMapsTest = test::RoevoOdometryTest;

TEST_F(RoevoOdometryMapsTest, TheSimpleMapHoldsTheMapsPoints) {
    scan_->sensorPose = CPose3D(0.3, -0.1, 0.8, 0.4, 0.2, -0.1);
    odometry_.processObservation(*scan_);
    const test::TemporaryFolder folder;
    odometry_.saveCurrentMapToFile(folder / "a.simplemap");
    mrpt::maps::CSimpleMap loaded;
    ASSERT_TRUE(loaded.loadFromFile(folder / "a.simplemap"));
    ASSERT_EQ(loaded.size(), 1u);
    mrpt::maps::CColouredPointsMap rebuilt;
    rebuilt.loadFromSimpleMap(loaded);
    const auto map = odometry_.getMap();
    ASSERT_EQ(rebuilt.size(), map->size());
    for (std::size_t i = 0; i < map->size(); i += 50) {
        float a[3], b[3];
        map->getPoint(i, a[0], a[1], a[2]);
        rebuilt.getPoint(i, b[0], b[1], b[2]);
        for (int axis = 0; axis < 3; axis++) EXPECT_NEAR(a[axis], b[axis], 1e-4);
    }
}

TEST_F(RoevoOdometryMapsTest, OnlyBundleAdjustmentTellsWhichEdgesAreTheSame) {
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        odometry_.options.odometry.mode = mode;
        odometry_.initialize();
        odometry_.processObservation(*scan_);
        const auto scene = odometry_.getScene();
        EXPECT_TRUE(scene->getByName(SceneNames::kEdges));
        EXPECT_EQ(scene->getByName(SceneNames::kCovisibility) != nullptr, mode == Mode::kBundleAdjustment);
    }
}

TEST_F(RoevoOdometryMapsTest, TheMapLeavesOutPseudoEdgesTheSimpleMapDoesNot) {
    odometry_.options.odometry.mode = Mode::kBundleAdjustment;
    odometry_.options.odometry.keyframe.min_overlap = 1;  // many keyframes
    odometry_.processObservation(*scan_);
    // The left third of what the first keyframe sees is not seen again
    cv::Mat image = scan_->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    image.colRange(0, image.cols / 3).setTo(128);
    scan_->intensityImage = mrpt::img::CImage(image, mrpt::img::DEEP_COPY);
    for (int i = 1; i < 10; i++) odometry_.processObservation(*laterScan(*scan_, 0.033 * i));

    std::size_t pseudo = 0, kept = 0, of_keyframes = 0, in_simple_map = 0;
    for (const MapEdge& edge : odometry_.odometry()->map())
        (isPseudo(edge.verdict) ? pseudo : kept) += edge.points.size();
    for (const MapEdge& edge : odometry_.odometry()->keyframeEdges()) of_keyframes += edge.points.size();
    EXPECT_GT(pseudo, 100u);
    EXPECT_EQ(odometry_.getMap()->size(), kept);
    EXPECT_TRUE(odometry_.getScene()->getByName(SceneNames::kPseudoEdges));

    mrpt::maps::CSimpleMap map;
    odometry_.getCurrentlyBuiltMap(map);
    EXPECT_GT(map.size(), 3u);
    for (const auto& keyframe : map) {
        mrpt::maps::CColouredPointsMap cloud;
        keyframe.sf->insertObservationsInto(cloud);
        in_simple_map += cloud.size();
    }
    EXPECT_EQ(in_simple_map, of_keyframes);
    EXPECT_GT(of_keyframes, kept + pseudo);
}

TEST_F(RoevoOdometryMapsTest, HowWellAKeyframeIsKnownIsInTheSimpleMapAlsoWhereTheFrameBeforeBecameIt) {
    odometry_.options.odometry.keyframe.min_overlap = 1;
    for (int i = 0; i < 3; i++) odometry_.processObservation(*laterScan(*scan_, 0.033 * i));
    cv::Mat image = scan_->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    image.colRange(0, image.cols / 3).setTo(128);
    scan_->intensityImage = mrpt::img::CImage(image, mrpt::img::DEEP_COPY);
    const auto sees_less = laterScan(*scan_, 0.1);
    ASSERT_TRUE(odometry_.processObservation(*sees_less).new_keyframe);
    ASSERT_LT(odometry_.odometry()->keyframes().back().timestamp, fromMrptTime(sees_less->timestamp));
    mrpt::maps::CSimpleMap map;
    odometry_.getCurrentlyBuiltMap(map);
    ASSERT_EQ(map.size(), 2u);
    int known = 0;
    for (const auto& keyframe : map)
        if (std::dynamic_pointer_cast<mrpt::poses::CPose3DPDFGaussian>(keyframe.pose)->cov.trace() > 0)
            ++known;
    EXPECT_EQ(known, 1) << "the first one is the world";
}

TEST_F(RoevoOdometryMapsTest, TheSemiDenseMapIsTheSurfaceInTheRobotsWorld) {
    EXPECT_TRUE(odometry_.getSemiDenseMap()->empty());
    const CPose3D mounted(0.3, -0.1, 0.8, 0.4, 0.2, -0.1), start(1, 2, 0, 0.7, 0, 0);
    scan_->sensorPose = mounted;
    odometry_.initialize(start);
    odometry_.processObservation(*scan_);
    const auto map = odometry_.getSemiDenseMap();
    const auto points = odometry_.odometry()->semiDense();
    ASSERT_GT(map->size(), 1000u);
    ASSERT_EQ(map->size(), points.size());
    EXPECT_TRUE(odometry_.getScene()->getByName(SceneNames::kSemiDense));

    // Every point is a pixel with its depth and its colour
    const RgbdFrame frame = toRgbdFrame(*scan_);
    const PinholeCamera camera = odometry_.odometry()->camera();
    const Pose T_optical_world = (toEigen(start) * cameraOnRobot(*scan_)).inverse();
    for (std::size_t i = 0; i < map->size(); i += 20) {
        float x, y, z, r, g, b;
        map->getPointRGB(i, x, y, z, r, g, b);
        const Eigen::Vector3d seen = T_optical_world * Eigen::Vector3d(x, y, z);
        Eigen::Vector2d pixel = camera.project(seen);
        if (camera.isDistorted()) pixel = camera.distortPixel(pixel);
        // Positions are kept in steps of 0.3 mm, half of which is 0.05 px here: half way between two pixels
        // it may be either
        double off = 1;
        for (const double du : {-0.05, 0.05}) {
            for (const double dv : {-0.05, 0.05}) {
                const auto u = static_cast<int>(std::lround(pixel.x() + du));
                const auto v = static_cast<int>(std::lround(pixel.y() + dv));
                off = std::min(off, std::abs(static_cast<double>(frame.depth.at<float>(v, u)) - seen.z()));
            }
        }
        EXPECT_LT(off, 5e-4) << pixel.transpose();
        EXPECT_EQ(points[i].colour, (Rgb{static_cast<std::uint8_t>(std::lround(255 * r)),
                                         static_cast<std::uint8_t>(std::lround(255 * g)),
                                         static_cast<std::uint8_t>(std::lround(255 * b))}));
    }

    odometry_.options.odometry.mapping.semi_dense_points = 0;
    odometry_.initialize(start);
    odometry_.processObservation(*scan_);
    EXPECT_TRUE(odometry_.getSemiDenseMap()->empty());
    EXPECT_FALSE(odometry_.getScene()->getByName(SceneNames::kSemiDense));
}

TEST_F(RoevoOdometryMapsTest, WhatIsMaskedIsInNoMap) {
    const cv::Size size(static_cast<int>(scan_->cameraParamsIntensity.ncols),
                        static_cast<int>(scan_->cameraParamsIntensity.nrows));
    cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
    mask(cv::Rect(0, 0, size.width / 2, size.height)).setTo(255);
    odometry_.setMask(mask);
    mask.setTo(255);  // ours to use again
    EXPECT_EQ(odometry_.processObservation(*scan_).status, FrameStatus::kInitialised);
    const PinholeCamera& camera = odometry_.odometry()->camera();
    const Pose T_keyframe_world = odometry_.odometry()->keyframes().at(0).T_world_camera.inverse();
    std::size_t points = 0;
    for (const MapEdge& edge : odometry_.odometry()->keyframeEdges())
        for (const Eigen::Vector3f& point : edge.points) {
            const Eigen::Vector3d seen = T_keyframe_world * Eigen::Vector3d(point.cast<double>());
            EXPECT_LT(camera.fx * seen.x() / seen.z() + camera.cx, size.width / 2.);
            ++points;
        }
    EXPECT_GT(points, 200U);
    odometry_.setMask(cv::Mat::zeros(3, 3, CV_8UC1));
    EXPECT_NE(odometry_.processObservation(*laterScan(*scan_, 0.03)).reason.find("mask is 3x3"),
              std::string::npos);
}

TEST_F(RoevoOdometryMapsTest, ASimpleMapThatCannotBeWrittenSaysWhy) {
    odometry_.processObservation(*scan_);
    const std::string error = errorOf([&] { odometry_.saveCurrentMapToFile("/nowhere/m.simplemap"); });
    EXPECT_EQ(error, "cannot write /nowhere/m.simplemap: No such file or directory");
}

/// What was mapped yesterday is where the robot is today, wherever it thinks that it begins.
TEST_F(RoevoOdometryMapsTest, BeginsWithTheMapOfAnEarlierRun) {
    const test::TemporaryFolder folder;
    const std::string map = folder / "yesterday.roevomap";
    const CPose3D yesterday(1, 2, 0, 0.7, 0, 0);
    odometry_.initialize(yesterday);
    odometry_.processObservation(*scan_);
    EXPECT_EQ(odometry_.saveMapToFile(map), 1);

    odometry_.initialize();
    odometry_.loadMapFromFile(map, MapUse::kLocalise);
    auto first = laterScan(*scan_, 60);
    auto dark = mrpt::obs::CObservation3DRangeScan::Create(*first);
    dark->rangeImage.setZero();
    EXPECT_EQ(odometry_.processObservation(*dark).status, FrameStatus::kRejected);
    mrpt::maps::CSimpleMap known;
    odometry_.getCurrentlyBuiltMap(known);
    EXPECT_EQ(known.size(), 0u) << "it is not known where that is";

    const FrameResult found = odometry_.processObservation(*laterScan(*scan_, 61));
    EXPECT_EQ(found.status, FrameStatus::kInitialised) << found.reason;
    EXPECT_NE(found.reason.find("found in the map"), std::string::npos) << found.reason;
    EXPECT_LT(CPose3D(odometry_.getCurrentPoseEstimation()->getMeanVal() - yesterday).norm(), 0.01);
    EXPECT_TRUE(odometry_.odometry()->isLocalised());
    odometry_.getCurrentlyBuiltMap(known);
    EXPECT_EQ(known.size(), 2u);
    EXPECT_THROW(odometry_.loadMapFromFile(map), std::logic_error);
    EXPECT_THROW(odometry_.saveMapToFile(map), std::logic_error) << "it stays as it is";

    odometry_.initialize();  // forgets the map, too
    odometry_.processObservation(*scan_);
    EXPECT_LT(odometry_.getCurrentPoseEstimation()->getMeanVal().norm(), 1e-9);
}

TEST_F(RoevoOdometryMapsTest, WithAnUnusableMapOrOptionNothingBegins) {
    const test::TemporaryFolder folder;
    EXPECT_NE(errorOf([&] { odometry_.saveMapToFile(folder / "m"); }).find("no keyframe"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "m"));
    test::writeFile(folder / "m", "no map");
    EXPECT_NE(errorOf([&] {
                  odometry_.loadMapFromFile(folder / "nowhere");
              }).find("cannot read " + (folder / "nowhere")),
              std::string::npos);
    odometry_.loadMapFromFile(folder / "m");
    for (int i = 0; i < 2; ++i) {
        const std::string error = errorOf([&] { odometry_.processObservation(*scan_); });
        EXPECT_NE(error.find(folder / "m"), std::string::npos) << error;
    }
    odometry_.initialize();
    odometry_.options.odometry.keyframe.max_translation = -1;
    EXPECT_NE(errorOf([&] { odometry_.processObservation(*scan_); }).find("keyframe.max_translation"),
              std::string::npos);
    EXPECT_FALSE(odometry_.odometry());
}

}  // namespace
}  // namespace roevo
