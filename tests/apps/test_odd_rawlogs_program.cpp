// roevo-odometry on rawlogs of robots: where the camera sits, several cameras, images that are gone.
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

#include "evaluation/trajectory_io.h"
#include "mrpt/synthetic_scan.h"
#include "odometry_fixture.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::OdometryProgram;
using test::slidingRecording;

class OddRawlogProgram : public OdometryProgram {
  protected:
    static mrpt::obs::CObservation3DRangeScan::Ptr scan(const test::TumFrame& frame,
                                                        const std::string& label = "RGBD") {
        auto made = test::makeScan(frame.timestamp, {320, 240, 300, 300, 160, 120, {}}, frame.depth,
                                   frame.colour, label);
        made->rangeUnits = 1.f / 5000;
        return made;
    }

    std::string write(const std::vector<mrpt::obs::CObservation3DRangeScan::Ptr>& scans) const {
        mrpt::io::CFileGZOutputStream stream(folder_ / "r.rawlog");
        auto archive = mrpt::serialization::archiveFrom(stream);
        for (const auto& each : scans) archive << *each;
        return folder_ / "r.rawlog";
    }
};

TEST_F(OddRawlogProgram, TheRobotsTrajectoryIsWrittenWhenTheCameraIsMountedOnOne) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(6)) {
        scans.push_back(scan(frame));
        // Looks to the robot's left, from half a metre before its middle
        scans.back()->sensorPose = mrpt::poses::CPose3D(0.5, 0, 1, mrpt::DEG2RAD(90.0), 0, 0);
    }
    const auto result = run(write(scans), {"--mode", "tr"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const auto camera = readTumTrajectory(output() + "/trajectory.txt");
    const auto robot = readTumTrajectory(output() + "/trajectory_robot.txt");
    ASSERT_EQ(robot.size(), 6u);
    EXPECT_TRUE(robot.front().T_world_camera.isApprox(Pose::Identity(), 1e-8));
    for (std::size_t i = 0; i < robot.size(); i++) {
        EXPECT_EQ(robot[i].timestamp, camera[i].timestamp);
        // The camera's right is the robot's front
        EXPECT_NEAR(robot[i].T_world_camera.translation().x(), camera[i].T_world_camera.translation().x(),
                    2e-3);
        EXPECT_NEAR(robot[i].T_world_camera.translation().z(), 0, 5e-3);
    }
    EXPECT_NEAR(std::abs(robot.back().T_world_camera.translation().x()), 0.05, 0.005);

    // A run of another recording into the same folder does not leave it there
    for (auto& each : scans) each->sensorPose = mrpt::poses::CPose3D();
    ASSERT_EQ(run(write(scans), {"--mode", "tr"}).exit_code, 0);
    EXPECT_FALSE(fs::exists(output() + "/trajectory_robot.txt"));
}

TEST_F(OddRawlogProgram, SeveralCamerasAreListed) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(4)) {
        scans.push_back(scan(frame, "left"));
        scans.push_back(scan(frame, "right"));
    }
    const std::string rawlog = write(scans);
    expectError(run(rawlog), 1, kName, {"r.rawlog", "4 left, 4 right", "--sensor-label"});
    EXPECT_FALSE(fs::exists(output() + "/trajectory.txt"));
    EXPECT_EQ(run(rawlog, {"--sensor-label", "right"}).exit_code, 0);
    EXPECT_EQ(rows().size(), 4u);
}

TEST_F(OddRawlogProgram, PointsOnly) {
    auto points = scan(slidingRecording(1).front());
    points->hasRangeImage = false;
    points->hasPoints3D = true;
    expectError(run(write({points})), 1, kName, {"r.rawlog", "3D points", "grab_depth"});
}

TEST_F(OddRawlogProgram, LostImagesAreCountedTogether) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(6)) scans.push_back(scan(frame));
    scans[3]->intensityImage.setExternalStorage("lost1.png");
    scans[4]->intensityImage.setExternalStorage("lost2.png");
    const auto result = run(write(scans));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("2 rejected: image file not found\n"), std::string::npos) << result.out;
    EXPECT_EQ(summary()["frames"]["reasons"]["rejected: image file not found"], 2);
    EXPECT_NE(reason(4).find("lost2.png"), std::string::npos) << "each frame still names its own";

    for (auto& each : scans) each->intensityImage.setExternalStorage("none.png");
    expectError(run(write(scans)), 1, kName, {"none of the 6 frames", "6 of them", "none.png"});
}

}  // namespace
}  // namespace roevo
