// --simplemap and --rawlog-with-poses: what MRPT reads from them is what the run's own files say.
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/core.hpp>

#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::readFile;
using test::runProgram;

constexpr std::size_t kWrittenFrames = 8;
const mrpt::poses::CPose3D kMount(0.3, -0.1, 1.2, 0.4, 0.2, -0.1);

class MrptOutputsProgram : public test::OdometryProgram {
  protected:
    /// A walk through a room, the camera mounted askew on a robot with an inertial sensor.
    void record() const {
        ASSERT_EQ(runProgram("rawlog-simulate",
                             {"--scene", "livingroom", "--frames", std::to_string(kWrittenFrames), "--size",
                              "320x240", "--output", folder_ / "level.rawlog"})
                      .exit_code,
                  0);
        RawlogReader reader(folder_ / "level.rawlog");
        std::optional<RawlogWriter> writer;
        while (const auto scan = reader.next()) {
            if (!writer) writer.emplace(rawlog(), colourCameraOf(*scan));
            writer->addImu(fromMrptTime(scan->timestamp) - 0.01, {0, 0, 9.8});
            scan->sensorPose = kMount;
            scan->intensityImage.setExternalStorage(
                writer->addImageFile(scan->intensityImage.getExternalStorageFileAbsolutePath()));
            writer->add(*scan);
        }
        writer->finish();
    }

    test::ProgramResult runMounted(std::vector<std::string> more) const {
        more.insert(more.end(), {"--quiet", "--set", "keyframe.max_translation=0.01"});
        return run(rawlog(), more);
    }
    std::string rawlog() const { return folder_ / "mounted.rawlog"; }

    /// The same as pairs of actions and sensory frames: wheels that turn by 1 cm, the scan, one of a camera
    /// at the rear, and one of the first camera without depth. All stamps are 300 ns later.
    std::string withWheelsAndRearCamera() const {
        record();
        RawlogReader reader(rawlog());
        mrpt::io::CFileGZOutputStream stream(folder_ / "robot.rawlog");
        auto archive = mrpt::serialization::archiveFrom(stream);
        while (const auto scan = reader.next()) {
            scan->timestamp += mrpt::Clock::duration(3);
            mrpt::obs::CActionRobotMovement2D wheels;
            wheels.timestamp = scan->timestamp;
            wheels.computeFromOdometry({0.01, 0, 0}, {});
            mrpt::obs::CActionCollection actions;
            actions.insert(wheels);
            const auto rear = mrpt::obs::CObservation3DRangeScan::Create(*scan);
            rear->sensorLabel = "REAR";
            const auto blind = mrpt::obs::CObservation3DRangeScan::Create(*scan);
            blind->hasRangeImage = false;
            mrpt::obs::CSensoryFrame frame;
            for (const auto& each : {scan, rear, blind}) frame.insert(each);
            archive << actions << frame;
        }
        return folder_ / "robot.rawlog";
    }

    std::vector<StampedPose> robot() const { return readTumTrajectory(output() + "/trajectory_robot.txt"); }
    Pose robotAt(double timestamp) const {
        for (const StampedPose& pose : robot())
            if (std::abs(pose.timestamp - timestamp) < 1e-5) return pose.T_world_camera;
        ADD_FAILURE() << "no pose at " << timestamp;
        return {};
    }
};

void expectCovariance(const mrpt::math::CMatrixDouble66& covariance, double largest_sigma) {
    for (int i = 0; i < 6; i++) {
        EXPECT_GT(covariance(i, i), 0);
        EXPECT_LT(covariance(i, i), largest_sigma * largest_sigma);
        for (int j = 0; j < 6; j++) EXPECT_EQ(covariance(i, j), covariance(j, i));
    }
}

TEST_F(MrptOutputsProgram, TheSimpleMapHasTheKeyframesOfTheRun) {
    record();
    ASSERT_EQ(runMounted({"--simplemap", folder_ / "a.simplemap"}).exit_code, 0);
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(folder_ / "a.simplemap"));
    const auto keyframes = readTumTrajectory(output() + "/keyframes.txt");
    ASSERT_GT(keyframes.size(), 2u);
    ASSERT_EQ(map.size(), keyframes.size());
    std::size_t points = 0;
    auto written = keyframes.begin();
    for (const auto& keyframe : map) {  // MRPT's versions differ in get()
        const auto& frame = keyframe.sf;
        EXPECT_TRUE(toEigen(keyframe.pose->getMeanVal()).isApprox(robotAt((written++)->timestamp), 1e-6));
        ASSERT_EQ(frame->size(), 1u);
        const auto cloud = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
        ASSERT_TRUE(cloud);
        EXPECT_TRUE(toEigen(cloud->sensorPose).isApprox(toEigen(kMount), 1e-6));
        points += cloud->pointcloud->size();
    }
    EXPECT_GT(points, 1000u);
}

TEST_F(MrptOutputsProgram, ImagesInTheSimpleMapAreThoseOfTheKeyframesAndMeetTheirEdges) {
    record();
    ASSERT_EQ(runMounted({"--simplemap", folder_ / "a.simplemap", "--simplemap-images"}).exit_code, 0);
    std::map<double, RgbdFrame> recorded;
    RawlogReader reader(rawlog());
    while (const auto scan = reader.next()) recorded[fromMrptTime(scan->timestamp)] = toRgbdFrame(*scan);
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(folder_ / "a.simplemap"));
    for (const auto& keyframe : map) {
        const auto& frame = keyframe.sf;
        const auto scan = frame->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
        const auto edges = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
        ASSERT_TRUE(scan && edges);
        EXPECT_TRUE(toEigen(scan->sensorPose).isApprox(toEigen(kMount), 1e-6));
        const RgbdFrame again = toRgbdFrame(*scan);
        const RgbdFrame& original = recorded.at(again.timestamp);
        EXPECT_EQ(cv::norm(again.grey, original.grey, cv::NORM_INF), 0);
        EXPECT_LT(cv::norm(again.depth, original.depth, cv::NORM_INF), 1e-6);

        // As MRPT's programs do, both into one frame of reference
        mrpt::maps::CSimplePointsMap surface, lines;
        mrpt::obs::T3DPointsProjectionParams projection;
        projection.takeIntoAccountSensorPoseOnRobot = true;
        scan->unprojectInto(surface, projection);
        edges->insertObservationInto(lines);
        std::size_t near = 0, all = 0;
        for (std::size_t i = 0; i < lines.size(); i += 20, ++all) {
            float x = 0, y = 0, z = 0;
            lines.getPoint(i, x, y, z);
            float distance = 0;  // squared
            surface.kdTreeClosestPoint3D(x, y, z, distance);
            near += distance < 0.03F * 0.03F;
        }
        EXPECT_GT(all, 20u);
        EXPECT_GT(near, all * 9 / 10) << "of " << all;
    }
}

TEST_F(MrptOutputsProgram, TheRawlogHasAPoseAndAMotionAtEveryScan) {
    record();
    const std::string posed = folder_ / "posed.rawlog";
    ASSERT_EQ(runMounted({"--rawlog-with-poses", posed}).exit_code, 0);
    mrpt::obs::CRawlog log;
    ASSERT_TRUE(log.loadFromRawLogFile(posed));
    ASSERT_EQ(log.size(), 2 * kWrittenFrames);
    const auto path = robot();
    ASSERT_EQ(path.size(), kWrittenFrames);
    for (std::size_t i = 0; i < kWrittenFrames; ++i) {
        const auto frame = log.getAsObservations(2 * i + 1);
        ASSERT_TRUE(frame);
        EXPECT_TRUE(frame->getObservationByClass<mrpt::obs::CObservationIMU>());
        const auto scan = frame->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
        const auto pose = frame->getObservationByClass<mrpt::obs::CObservationRobotPose>();
        ASSERT_TRUE(scan && pose);
        EXPECT_EQ(scan->timestamp, pose->timestamp);
        EXPECT_TRUE(toEigen(pose->pose.mean).isApprox(path[i].T_world_camera, 1e-6));
        if (i > 0) expectCovariance(pose->pose.cov, 0.2);

        const auto action = log.getAsAction(2 * i);
        ASSERT_TRUE(action);
        const auto motion = action->getActionByClass<mrpt::obs::CActionRobotMovement3D>();
        ASSERT_EQ(motion != nullptr, i > 0);
        if (!motion) continue;
        EXPECT_EQ(motion->estimationMethod, mrpt::obs::CActionRobotMovement3D::emVisualOdometry);
        expectCovariance(motion->poseChange.cov, 0.1);
        const Pose moved = path[i - 1].T_world_camera.inverse() * path[i].T_world_camera;
        EXPECT_TRUE(toEigen(motion->poseChange.mean).isApprox(moved, 1e-6)) << i;
    }
}

TEST_F(MrptOutputsProgram, TheRawlogWithPosesGivesTheSamePosesAgain) {
    record();
    const std::string posed = folder_ / "posed.rawlog";
    ASSERT_EQ(runMounted({"--rawlog-with-poses", posed}).exit_code, 0);
    const std::string trajectory = readFile(output() + "/trajectory.txt");
    fs::remove(rawlog());  // it has images of its own
    fs::remove_all(RawlogWriter::imagesDirectory(rawlog()));
    ASSERT_EQ(run(posed, {"--quiet", "--set", "keyframe.max_translation=0.01"}).exit_code, 0);
    EXPECT_EQ(readFile(output() + "/trajectory.txt"), trajectory);
}

TEST_F(MrptOutputsProgram, OtherScansAndActionsOfTheRawlogAreKept) {
    const std::string robot = withWheelsAndRearCamera(), posed = folder_ / "posed.rawlog";
    const auto result = run(robot, {"--sensor-label", "RGBD", "--quiet", "--rawlog-with-poses", posed});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("8 scan(s) of RGBD without a range image left out"), std::string::npos)
        << result.err;
    mrpt::obs::CRawlog log;
    ASSERT_TRUE(log.loadFromRawLogFile(posed));
    std::map<std::string, std::size_t> kept;
    double wheels = 0;
    for (std::size_t i = 0; i < log.size(); ++i) {
        if (log.getType(i) == mrpt::obs::CRawlog::etActionCollection) {
            // MRPT's particle filters would take it in place of the motion that was seen
            EXPECT_FALSE(log.getAsAction(i)->getActionByClass<mrpt::obs::CActionRobotMovement2D>());
            continue;
        }
        std::optional<mrpt::Clock::time_point> posed_at;
        for (const auto& each : *log.getAsObservations(i)) {
            const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(each);
            ++kept[scan && !scan->hasRangeImage ? "blind" : each->sensorLabel];
            if (each->sensorLabel == "roevo") posed_at = each->timestamp;
            if (const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(each))
                wheels = odometry->odometry.x();
        }
        for (const auto& each : *log.getAsObservations(i))
            if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(each))
                if (posed_at && scan->hasRangeImage && scan->sensorLabel == "RGBD") {
                    EXPECT_EQ(scan->timestamp, *posed_at) << "to the tick";
                }
    }
    for (const char* what : {"RGBD", "REAR", "blind", "roevo"}) EXPECT_EQ(kept[what], kWrittenFrames) << what;
    EXPECT_NEAR(wheels, 0.01 * kWrittenFrames, 1e-9);
}

TEST_F(MrptOutputsProgram, OnlyFramesWithAPoseAreInTheRawlog) {
    record();
    fs::path damaged;
    for (const auto& image : fs::directory_iterator(RawlogWriter::imagesDirectory(rawlog())))
        if (damaged.empty() || image.path() < damaged) damaged = image.path();
    test::writeFile(damaged, "no image");  // hard-linked into the rawlog that was simulated, too
    const std::string posed = folder_ / "posed.rawlog";
    ASSERT_EQ(runMounted({"--rawlog-with-poses", posed, "--first", "6"}).exit_code, 0);
    RawlogReader reader(posed);
    std::size_t scans = 0;
    while (reader.next()) ++scans;
    EXPECT_EQ(scans, 5u);
}

TEST_F(MrptOutputsProgram, AFolderHasNoMountAndItsCameraLooksAlongX) {
    const auto frames = test::slidingRecording(8);
    ASSERT_EQ(runFrames(frames, {"--simplemap", folder_ / "a.simplemap"}).exit_code, 0);
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(folder_ / "a.simplemap"));
    ASSERT_GT(map.size(), 0u);
    const auto first = toEigen(map.begin()->pose->getMeanVal());
    EXPECT_TRUE(first.isApprox(Pose::Identity(), 1e-6));
    const auto edges = map.begin()->sf->getObservationByClass<mrpt::obs::CObservationPointCloud>();
    ASSERT_TRUE(edges);
    EXPECT_TRUE(toEigen(edges->sensorPose).isApprox(Pose::Identity(), 1e-6));
    mrpt::maps::CSimplePointsMap points;
    edges->insertObservationInto(points);
    EXPECT_GT(points.boundingBox().min.x, 0.3) << "all of it is ahead";
}

TEST_F(MrptOutputsProgram, WrongNamesCostNoWork) {
    record();
    const std::string posed = folder_ / "posed.rawlog";
    expectError(run(rawlog(), {"--rawlog-with-poses", folder_ / "posed.bag"}), 2, kName,
                {".rawlog", "posed.bag"});
    expectError(run(rawlog(), {"--rawlog-with-poses", rawlog()}), 2, kName, {"an input"});
    expectError(run(rawlog(), {"--simplemap", posed, "--rawlog-with-poses", posed}), 2, kName,
                {"--simplemap names"});
    expectError(run(rawlog(), {"--simplemap", folder_ / "a", "--map-out", folder_ / "a"}), 2, kName,
                {"--map-out names"});
    expectError(run(rawlog(), {"--simplemap-images"}), 2, kName, {"--simplemap"});
    expectError(run(rawlog(), {"--simplemap", folder_ / "no/such/a.simplemap"}), 1, kName, {"no/such"});
    expectError(runFrames(test::slidingRecording(3), {"--rawlog-with-poses", posed}), 2, kName,
                {"rgbd2rawlog"});
    EXPECT_FALSE(fs::exists(posed));
    EXPECT_FALSE(fs::exists(folder_ / "a"));
    EXPECT_FALSE(fs::exists(output() + "/trajectory.txt"));
}

}  // namespace
}  // namespace roevo
