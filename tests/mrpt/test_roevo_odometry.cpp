// Where the robot is, by what its camera sees.
#include <gtest/gtest.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <limits>

#include "mrpt/kinect_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"

namespace roevo {
namespace {

using mrpt::poses::CPose3D;
using test::errorOf;
using test::laterScan;

using RoevoOdometryTest = test::RoevoOdometryTest;

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

TEST_F(RoevoOdometryTest, PosesHaveTheTimeStampsOfTheirObservationsToTheTick) {
    std::vector<mrpt::Clock::time_point> stamps;
    for (int i = 0; i < 4; ++i) {
        const auto scan = laterScan(*scan_, 0.033 * i);
        scan->timestamp += mrpt::Clock::duration(2 * i + 1);  // of 100 ns
        stamps.push_back(scan->timestamp);
        ASSERT_TRUE(odometry_.processObservation(*scan).hasPose());
    }
    auto stamp = stamps.begin();
    for (const auto& [time, pose] : odometry_.getTrajectory()) EXPECT_EQ(time, *stamp++);
    EXPECT_EQ(stamp, stamps.end());
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

}  // namespace
}  // namespace roevo
