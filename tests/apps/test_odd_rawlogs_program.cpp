// roevo-odometry on rawlogs of robots: where the camera sits, several cameras, images that are gone.
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>

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

/// Ways for a sensor pose to be no rigid pose, each applied to a whole one.
const std::pair<const char*, void (*)(mrpt::poses::CPose3D&)> kBrokenPoses[] = {
    {"infinitely far", [](mrpt::poses::CPose3D& pose) { pose.x(INFINITY); }},
    {"not a number", [](mrpt::poses::CPose3D& pose) { pose.z(NAN); }},
    {"beyond the sun", [](mrpt::poses::CPose3D& pose) { pose.y(1e38); }},
    {"no rotation", [](mrpt::poses::CPose3D& pose) { pose.setRotationMatrix({}); }},
    {"a mirror",
     [](mrpt::poses::CPose3D& pose) {
         auto rotation = pose.getRotationMatrix();
         for (int row = 0; row < 3; row++) rotation(row, 1) *= -1;
         pose.setRotationMatrix(rotation);
     }},
    {"rotation of large numbers", [](mrpt::poses::CPose3D& pose) {
         auto rotation = pose.getRotationMatrix();
         rotation(1, 1) = 1.3e300;
         pose.setRotationMatrix(rotation);
     }}};

TEST_F(OddRawlogProgram, SensorPosesThatAreNotRigidCostTheirFrame) {
    // Every second frame is spoiled, the first of all too: poses of the sensor, then of its colour camera
    constexpr std::size_t kWays = std::size(kBrokenPoses), kFrames = 4 * kWays;
    const auto isOfColour = [](std::size_t frame) { return frame >= kFrames / 2; };
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(kFrames)) {
        const std::size_t i = scans.size();
        scans.push_back(scan(frame));
        scans.back()->sensorPose = mrpt::poses::CPose3D(0.5, 0, 1, 0.3, 0, 0);
        if (i % 2 == 0)
            kBrokenPoses[i / 2 % kWays].second(isOfColour(i) ? scans.back()->relativePoseIntensityWRTDepth
                                                             : scans.back()->sensorPose);
    }
    const auto result = run(write(scans), {"--mode", "tr"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    ASSERT_EQ(rows().size(), kFrames);
    for (std::size_t i = 0; i < kFrames; i++) {
        SCOPED_TRACE(kBrokenPoses[i / 2 % kWays].first);
        EXPECT_EQ(status(i), i % 2 == 0 ? "rejected"
                             : i == 1   ? "initialised"
                                        : "ok")
            << i << ' ' << reason(i);
        if (i % 2 == 1) continue;
        EXPECT_NE(reason(i).find(isOfColour(i) ? "pose of the colour camera is not rigid"
                                               : "sensor pose is not rigid"),
                  std::string::npos)
            << reason(i);
    }
    EXPECT_EQ(readTumTrajectory(output() + "/trajectory_robot.txt").size(), kFrames / 2);
}

TEST_F(OddRawlogProgram, NoSensorPoseIsRigid) {
    auto only = scan(slidingRecording(1).front());
    only->sensorPose.x(INFINITY);
    const std::string rawlog = write({only, only});
    expectError(run(rawlog), 1, kName, {"r.rawlog", "none of the 2 frames", "sensor pose", "not rigid"});
    expectError(test::runProgram("rawlog2rgbd", {"--input", rawlog, "--output", folder_ / "back"}), 1,
                "rawlog2rgbd", {"r.rawlog", "none of its 2 frames", "sensor pose", "not rigid"});
}

TEST_F(OddRawlogProgram, ARangeImageThatPromisesMoreThanFits) {
    const auto frames = slidingRecording(4);
    const std::vector<std::uint32_t> sizes[] = {{1057954685, 382}, {65535, 65535}};  // 808 GB, 8.6 GB
    for (const auto& size : sizes)
        for (const std::size_t bad : {0u, 2u}) {
            std::string bytes;
            for (std::size_t i = 0; i < frames.size(); i++) {
                std::string object = test::bytesOf(*scan(frames[i]));
                const std::uint32_t true_size[] = {240, 320};
                const std::size_t at =
                    object.find(std::string(reinterpret_cast<const char*>(true_size), sizeof true_size));
                ASSERT_NE(at, std::string::npos);
                if (i == bad) std::memcpy(&object[at], size.data(), sizeof true_size);
                bytes += object;
            }
            test::writeFile(folder_ / "r.rawlog", bytes);
            const auto result = run(folder_ / "r.rawlog", {"--mode", "tr"});
            if (bad == 0) {
                expectError(result, 1, kName, {"r.rawlog", "not a rawlog"});
                continue;
            }
            EXPECT_EQ(result.exit_code, 0) << result.all();
            EXPECT_NE(result.err.find("warning"), std::string::npos) << result.all();
            EXPECT_NE(result.err.find("entry 3"), std::string::npos) << result.all();
            EXPECT_EQ(rows().size(), 2u);
        }
}

/// MRPT decodes images inside a rawlog with libjpeg, which ends the program where they are none.
TEST_F(OddRawlogProgram, ADamagedJpegInsideCostsItsFrame) {
    const auto frames = slidingRecording(6);
    const std::string head = "\xff\xd8\xff";
    const std::string size("\xff\xc0\x00\x11\x08\x00\xf0\x01\x40", 9);  // 240 x 320, in the frame header
    enum Damage { kHead, kMiddle, kTables, kSize, kLength };
    const test::ColourAsJpeg jpeg;
    for (const Damage damage : {kHead, kMiddle, kTables, kSize, kLength}) {
        SCOPED_TRACE(damage);
        std::string bytes;
        for (std::size_t i = 0; i < frames.size(); i++) {
            std::string object = test::bytesOf(*scan(frames[i]));
            const std::size_t at = object.find(head);
            ASSERT_NE(at, std::string::npos) << "MRPT writes another format";
            std::uint32_t length = 0;
            std::memcpy(&length, &object[at - sizeof length], sizeof length);
            ASSERT_LE(at + length, object.size());
            if (i == 3 && damage == kHead) object[at] = '\x0f';
            if (i == 3 && damage == kMiddle) std::memset(&object[at + length / 2], 0xff, 200);
            if (i == 3 && damage == kTables) std::memset(&object[at + 22], 0xee, 100);
            const std::size_t header = object.find(size, at);
            ASSERT_NE(header, std::string::npos);
            if (i == 3 && damage == kSize) object.replace(header + 5, 4, "\xea\x60\xea\x60");  // 60,000
            if (i == 3 && damage == kLength) std::memset(&object[at - sizeof length], 0xff, sizeof length);
            bytes += object;
        }
        test::writeFile(folder_ / "r.rawlog", bytes);
        const auto result = run(folder_ / "r.rawlog", {"--mode", "tr"});
        ASSERT_EQ(result.exit_code, 0) << result.all();
        EXPECT_NE(result.err.find("entry 4"), std::string::npos) << result.err;
        if (damage == kLength) {  // where the next object begins is not known
            EXPECT_EQ(rows().size(), 3u);
            continue;
        }
        EXPECT_NE(result.err.find("1 entry with a damaged JPEG"), std::string::npos) << result.err;
        ASSERT_EQ(rows().size(), 6u);
        EXPECT_EQ(status(3), "rejected");
        EXPECT_NE(reason(3).find("colour image is damaged"), std::string::npos) << reason(3);
        expectOthersTracked(3, 6);
    }
}

TEST_F(OddRawlogProgram, NamesThatCannotBeShown) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(2)) {
        scans.push_back(scan(frame, std::string(50000, 'x')));
        scans.push_back(scan(frame, "\x1b[2J\xff"));
        scans.back()->intensityImage.setExternalStorage(std::string(50000, 'y') + "\x1b[2J");
    }
    const std::string rawlog = write(scans);
    auto result = run(rawlog);
    expectError(result, 1, kName, {"2 ?[2J?", "xx…", "--sensor-label"});
    EXPECT_LT(result.err.size(), 1000u);
    result = run(rawlog, {"--sensor-label", "\x1b[2J\xff"});
    expectError(result, 1, kName, {"none of the 2 frames", "yyy"});
    EXPECT_LT(result.err.size(), 3000u);
    EXPECT_EQ(result.err.find("\x1b"), std::string::npos);
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

TEST_F(OddRawlogProgram, AScanWithoutATimeStampIsRejectedAndSaysNothingOfTheRate) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(6)) scans.push_back(scan(frame));
    scans[0]->timestamp = INVALID_TIMESTAMP;
    const auto result = run(write(scans));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(result.out.find(" Hz"), std::string::npos) << result.out;
    EXPECT_EQ(status(0), "rejected");
    expectOthersTracked(0, 6);
}

TEST_F(OddRawlogProgram, ManyFramesThatAreNotUsedAreWarnedOf) {
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
    for (const auto& frame : slidingRecording(8)) scans.push_back(scan(frame));
    for (std::size_t i : {3u, 5u, 6u, 7u}) scans[i]->timestamp = scans[i - 2]->timestamp;
    scans.insert(scans.begin() + 2, 3, scan(slidingRecording(1).front()));
    for (std::size_t i : {2u, 3u, 4u}) scans[i]->hasRangeImage = false;
    const auto result = run(write(scans), {"--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("warning: 3 scan(s) of RGBD without a range image left out"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("warning: 4 of the 8 frames are rejected, 3 of them: time stamp goes backward"),
              std::string::npos)
        << result.err;
    EXPECT_NE(summary()["input"]["warning"].get<std::string>().find("3 scan(s) of RGBD"), std::string::npos);
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
