#include <gtest/gtest.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/roevo_odometry.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

using mrpt::poses::CPose3D;
using test::errorOf;

mrpt::obs::CObservation3DRangeScan::Ptr kinectScan() {
    const char* const file = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
    return std::filesystem::exists(file) ? RawlogReader(file).next() : nullptr;
}

/// The same view at a later time.
mrpt::obs::CObservation3DRangeScan::Ptr laterScan(const mrpt::obs::CObservation3DRangeScan& scan,
                                                  double seconds) {
    auto later = mrpt::obs::CObservation3DRangeScan::Create(scan);
    later->timestamp = toMrptTime(fromMrptTime(scan.timestamp) + seconds);
    return later;
}

class RoevoOdometryTest : public ::testing::Test {
  protected:
    void SetUp() override {
        scan_ = kinectScan();
        if (!scan_) GTEST_SKIP() << "tests_rgbd.rawlog (package mrpt-common) not installed";
        odometry_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    }
    mrpt::obs::CObservation3DRangeScan::Ptr scan_;
    CRoevoOdometry odometry_;
};

TEST_F(RoevoOdometryTest, TheFirstObservationInitialises) {
    EXPECT_FALSE(odometry_.getCurrentPoseEstimation());
    const FrameResult result = odometry_.processObservation(*scan_);
    EXPECT_EQ(result.status, FrameStatus::kInitialised) << result.reason;
    EXPECT_EQ(odometry_.getCurrentlyBuiltMapSize(), 1u);
    EXPECT_GT(odometry_.getMap()->size(), 500u);
    EXPECT_TRUE(odometry_.getScene()->getByName("edges"));
    const auto pose = odometry_.getCurrentPoseEstimation();
    ASSERT_TRUE(pose);
    EXPECT_TRUE(toEigen(pose->getMeanVal()).isApprox(Pose::Identity(), 1e-9));
}

TEST_F(RoevoOdometryTest, AStillCameraStaysAndTheRobotIsWhereTheSensorPoseSays) {
    const CPose3D mounted(0.3, -0.1, 0.8, 0.4, 0.2, -0.1), start(1, 2, 0, 0.7, 0, 0);
    scan_->sensorPose = mounted;
    odometry_.initialize(start);
    odometry_.processObservation(*scan_);
    const FrameResult second = odometry_.processObservation(*laterScan(*scan_, 0.033));
    ASSERT_EQ(second.status, FrameStatus::kOk) << second.reason;
    odometry_.refineAll();
    const auto path = odometry_.getTrajectory();
    ASSERT_EQ(path.size(), 2u);
    for (const auto& [time, pose] : path) EXPECT_TRUE(toEigen(CPose3D(pose)).isApprox(toEigen(start), 1e-3));
    EXPECT_TRUE(second.T_world_camera.isApprox(toEigen(start) * cameraOnRobot(*scan_), 1e-3));

    // Points of the map, seen from the sensor, are ahead of it by the distance of the bookcase.
    const auto map = odometry_.getMap();
    const Pose T_sensor_world = (toEigen(start) * toEigen(mounted)).inverse();
    for (std::size_t i = 0; i < map->size(); i += 50) {
        float x = 0, y = 0, z = 0;
        map->getPoint(i, x, y, z);
        const double ahead = (T_sensor_world * Eigen::Vector3d(x, y, z)).x();
        EXPECT_GT(ahead, 1);
        EXPECT_LT(ahead, 3);
    }
}

TEST_F(RoevoOdometryTest, WhereTheColourCameraIsOnTheSensorCounts) {
    scan_->sensorPose = CPose3D(0.3, -0.1, 0.8, 0.4, 0.2, -0.1);
    scan_->relativePoseIntensityWRTDepth = CPose3D(0.025, 0, 0, 0, 0, 0) + toMrpt(sensorFromOptical());
    const CPose3D start(1, 2, 0, 0.7, 0, 0);
    odometry_.initialize(start);
    const FrameResult first = odometry_.processObservation(*scan_);
    ASSERT_EQ(first.status, FrameStatus::kInitialised) << first.reason;
    EXPECT_TRUE(first.T_world_camera.isApprox(toEigen(start) * cameraOnRobot(*scan_), 1e-9));
    EXPECT_TRUE(toEigen(odometry_.getCurrentPoseEstimation()->getMeanVal()).isApprox(toEigen(start), 1e-9));
}

TEST_F(RoevoOdometryTest, AFirstObservationWithoutARigidPoseBeginsNothing) {
    auto bad = laterScan(*scan_, -0.1);
    auto& rotation = const_cast<mrpt::math::CMatrixDouble33&>(bad->sensorPose.getRotationMatrix());
    rotation(0, 0) = std::nan("");
    const FrameResult result = odometry_.processObservation(*bad);
    EXPECT_EQ(result.status, FrameStatus::kRejected);
    EXPECT_NE(result.reason.find("sensor pose"), std::string::npos) << result.reason;
    EXPECT_EQ(odometry_.processObservation(*scan_).status, FrameStatus::kInitialised);
    EXPECT_TRUE(toEigen(odometry_.getCurrentPoseEstimation()->getMeanVal()).isApprox(Pose::Identity(), 1e-9));
}

TEST_F(RoevoOdometryTest, TheSimpleMapHoldsTheMapsPoints) {
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

TEST_F(RoevoOdometryTest, OnlyBundleAdjustmentTellsWhichEdgesAreTheSame) {
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        odometry_.options.odometry.mode = mode;
        odometry_.initialize();
        odometry_.processObservation(*scan_);
        const auto scene = odometry_.getScene();
        EXPECT_TRUE(scene->getByName(SceneNames::kEdges));
        EXPECT_EQ(scene->getByName(SceneNames::kCovisibility) != nullptr, mode == Mode::kBundleAdjustment);
    }
}

TEST_F(RoevoOdometryTest, TheMapLeavesOutPseudoEdgesTheSimpleMapDoesNot) {
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

TEST_F(RoevoOdometryTest, HowWellAKeyframeIsKnownIsInTheSimpleMapAlsoWhereTheFrameBeforeBecameIt) {
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

TEST_F(RoevoOdometryTest, TheSemiDenseMapIsTheSurfaceInTheRobotsWorld) {
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

TEST_F(RoevoOdometryTest, WhatIsMaskedIsInNoMap) {
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

TEST_F(RoevoOdometryTest, SensoryFramesAndStartPosesOfMrpt) {
    mrpt::poses::CPosePDFGaussian x0;
    x0.mean = mrpt::poses::CPose2D(3, 4, 0.5);
    odometry_.initialize({}, &x0);
    mrpt::obs::CActionCollection action;
    mrpt::obs::CSensoryFrame frame;
    frame.insert(scan_);
    odometry_.processActionObservation(action, frame);
    ASSERT_TRUE(odometry_.getCurrentPoseEstimation());
    EXPECT_TRUE(toEigen(odometry_.getCurrentPoseEstimation()->getMeanVal())
                    .isApprox(toEigen(CPose3D(3, 4, 0, 0.5, 0, 0)), 1e-9));
    std::map<std::string, mrpt::system::CTimeLogger::TCallStats> stats;
    odometry_.profiler().getStats(stats);
    EXPECT_EQ(stats["track"].n_calls, 1u);
    odometry_.initialize();
    EXPECT_EQ(odometry_.getCurrentlyBuiltMapSize(), 0u);
    mrpt::maps::CSimpleMap not_empty;
    not_empty.insert(mrpt::poses::CPose3DPDFGaussian::Create(), mrpt::obs::CSensoryFrame::Create(frame));
    EXPECT_THROW(odometry_.initialize(not_empty), std::invalid_argument);
}

TEST_F(RoevoOdometryTest, BadObservationsAreRejectedWithAReason) {
    auto lost = laterScan(*scan_, 0.03), other_camera = laterScan(*scan_, 0.06),
         empty = laterScan(*scan_, 0.09);
    lost->intensityImage.setExternalStorage("/nowhere/lost.png");
    other_camera->cameraParamsIntensity.fx(400);
    auto other_sensor = laterScan(*scan_, 0.1), no_image = laterScan(*scan_, 0.11);
    other_sensor->sensorLabel = "BACK";
    no_image->intensityImage = mrpt::img::CImage();  // of which MRPT throws
    empty->cameraParamsIntensity = {};
    EXPECT_NE(errorOf([&] { odometry_.processObservation(*empty); }).find("no intrinsics"),
              std::string::npos);
    odometry_.processObservation(*scan_);
    for (const auto& [bad, reason] : {std::pair(lost, "lost.png"),
                                      {other_camera, "intrinsics changed"},
                                      {empty, "no intrinsics"},
                                      {other_sensor, "'BACK'"},
                                      {no_image, "no colour or grey image"}}) {
        const FrameResult result = odometry_.processObservation(*bad);
        EXPECT_EQ(result.status, FrameStatus::kRejected);
        EXPECT_EQ(result.reason.find('\n'), std::string::npos) << result.reason;
        EXPECT_NE(result.reason.find(reason), std::string::npos) << result.reason;
    }
    EXPECT_EQ(odometry_.getTrajectory().size(), 1u);
    EXPECT_EQ(odometry_.processObservation(*laterScan(*scan_, 0.12)).status, FrameStatus::kOk);
}

/// A scan in which nothing can be tracked.
mrpt::obs::CObservation3DRangeScan::Ptr withoutDepth(const mrpt::obs::CObservation3DRangeScan& scan,
                                                     double seconds) {
    auto covered = laterScan(scan, seconds);
    covered->rangeImage.setZero();
    return covered;
}

TEST_F(RoevoOdometryTest, TheRobotBeginsWhereTheFirstScanThatGivesAPoseSeesFrom) {
    const CPose3D start(1, 2, 0);
    odometry_.initialize(start);
    auto tilted = withoutDepth(*scan_, 0);
    tilted->sensorPose = CPose3D(0.2, 0, 1, 0, 0.5, 0);
    EXPECT_EQ(odometry_.processObservation(*tilted).status, FrameStatus::kRejected);
    EXPECT_FALSE(odometry_.odometry());
    auto level = laterScan(*scan_, 0.03);
    level->sensorPose = CPose3D(0.2, 0, 1, 0, 0, 0);
    ASSERT_EQ(odometry_.processObservation(*level).status, FrameStatus::kInitialised);
    EXPECT_TRUE(toEigen(odometry_.getCurrentPoseEstimation()->getMeanVal()).isApprox(toEigen(start), 1e-9));
}

TEST_F(RoevoOdometryTest, ACoveredCameraDoesNotKeepOthersFromBeginning) {
    auto covered = withoutDepth(*scan_, 0);
    covered->sensorLabel = "REAR";
    covered->cameraParamsIntensity.fx(400);
    EXPECT_EQ(odometry_.processObservation(*covered).status, FrameStatus::kRejected);
    EXPECT_EQ(odometry_.processObservation(*laterScan(*scan_, 0.03)).status, FrameStatus::kInitialised);
    EXPECT_EQ(odometry_.processObservation(*laterScan(*scan_, 0.06)).status, FrameStatus::kOk);
}

TEST_F(RoevoOdometryTest, FollowsTheSensorThatIsNamed) {
    auto rear = laterScan(*scan_, 0.01);
    rear->sensorLabel = "REAR";
    mrpt::obs::CActionCollection none;
    mrpt::obs::CSensoryFrame both;
    both.insert(scan_);
    both.insert(rear);
    odometry_.sensor_label = "REAR";
    odometry_.processActionObservation(none, both);
    ASSERT_EQ(odometry_.getTrajectory().size(), 1u);
    EXPECT_EQ(odometry_.getTrajectory().begin()->first, rear->timestamp);
    const FrameResult other = odometry_.processObservation(*laterScan(*scan_, 0.02));
    EXPECT_NE(other.reason.find("follows 'REAR'"), std::string::npos) << other.reason;
}

TEST_F(RoevoOdometryTest, MotionsAreTheRobots) {
    const CPose3D mounted(0.3, -0.1, 0.8, 0.4, 0.2, -0.1);
    scan_->sensorPose = mounted;
    std::vector<FrameResult> results;
    for (int i = 0; i < 4; ++i)
        results.push_back(odometry_.processObservation(*laterScan(*scan_, 0.033 * i)));
    const auto motion = odometry_.getMotion(results[1], results[3]);
    const auto trajectory = odometry_.getTrajectory();
    const CPose3D from(trajectory.at(toMrptTime(results[1].timestamp))),
        to(trajectory.at(toMrptTime(results[3].timestamp)));
    EXPECT_LT((CPose3D(to - from) - motion.mean).norm(), 1e-3);  // final poses are smoothed
    EXPECT_GT(motion.cov(0, 0), 0);
    EXPECT_THROW(odometry_.getMotion(results[1], FrameResult()), std::out_of_range);
}

TEST(RobotMotion, WhereNothingIsKnownIsInfinite) {
    const Pose mount = toEigen(CPose3D(0.3, -0.1, 0.8, 0.4, 0.2, -0.1));
    const auto motion =
        robotMotion(Pose(), Matrix6d::Constant(std::numeric_limits<double>::infinity()), mount, mount);
    EXPECT_LT(motion.mean.norm(), 1e-9);
    for (int i = 0; i < 6; ++i) EXPECT_TRUE(std::isinf(motion.cov(i, i))) << i;
}

TEST_F(RoevoOdometryTest, ASimpleMapThatCannotBeWrittenSaysWhy) {
    odometry_.processObservation(*scan_);
    const std::string error = errorOf([&] { odometry_.saveCurrentMapToFile("/nowhere/m.simplemap"); });
    EXPECT_EQ(error, "cannot write /nowhere/m.simplemap: No such file or directory");
}

TEST_F(RoevoOdometryTest, AScanThatIsRejectedMovesNothing) {
    odometry_.processObservation(*scan_);
    odometry_.processObservation(*laterScan(*scan_, 0.06));
    auto late = laterScan(*scan_, 0.03);
    late->sensorPose = CPose3D(5, 0, 0, 0, 0, 0);
    EXPECT_EQ(odometry_.processObservation(*late).status, FrameStatus::kRejected);
    for (const auto& [time, pose] : odometry_.getTrajectory()) EXPECT_LT(CPose3D(pose).norm(), 0.01);
    EXPECT_LT(odometry_.getCurrentPoseEstimation()->getMeanVal().norm(), 0.01);
}

TEST_F(RoevoOdometryTest, TheCurrentPoseIsTheTrajectorysLast) {
    for (int i = 0; i < 4; ++i) odometry_.processObservation(*laterScan(*scan_, 0.033 * i));
    odometry_.refineAll();
    const CPose3D last(odometry_.getTrajectory().rbegin()->second);
    EXPECT_TRUE(toEigen(odometry_.getCurrentPoseEstimation()->getMeanVal()).isApprox(toEigen(last), 1e-12));
}

/// What was mapped yesterday is where the robot is today, wherever it thinks that it begins.
TEST_F(RoevoOdometryTest, BeginsWithTheMapOfAnEarlierRun) {
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

TEST_F(RoevoOdometryTest, WithAnUnusableMapOrOptionNothingBegins) {
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
