// Rawlogs with something wrong in them.
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::OdometryProgram;
using test::slidingRecording;

class BadRawlog : public OdometryProgram {
  protected:
    static PinholeCamera camera() { return {320, 240, 300, 300, 160, 120, {}}; }

    std::string writeRawlog(const std::vector<test::TumFrame>& frames) const {
        RawlogWriter writer(folder_ / "r.rawlog", camera());
        for (const auto& frame : frames) writer.add(frame.timestamp, frame.depth, frame.colour);
        writer.finish();
        return folder_ / "r.rawlog";
    }
};

TEST_F(BadRawlog, NotARawlog) {
    test::writeFile(folder_ / "text.rawlog", "this is text\n");
    expectError(run(folder_ / "text.rawlog"), 1, kName, {"text.rawlog", "not a rawlog"});
    test::writeFile(folder_ / "empty.rawlog", "");
    expectError(run(folder_ / "empty.rawlog"), 1, kName, {"empty.rawlog"});
    test::writeFile(folder_ / "film.mp4", "this is no film\n");
    expectError(run(folder_ / "film.mp4"), 1, kName, {"film.mp4", ".rawlog files", ".bag", "folders"});
}

TEST_F(BadRawlog, WithoutRangeImages) {
    {
        mrpt::io::CFileGZOutputStream file(folder_ / "gps.rawlog");
        auto archive = mrpt::serialization::archiveFrom(file);
        for (int i = 0; i < 3; ++i) archive << mrpt::obs::CObservationGPS();
    }
    expectError(run(folder_ / "gps.rawlog"), 1, kName, {"gps.rawlog", "CObservationGPS"});
}

TEST_F(BadRawlog, TruncatedIsReportedAndUsedAsFarAsItGoes) {
    const std::string rawlog = writeRawlog(slidingRecording(10));
    fs::resize_file(rawlog, fs::file_size(rawlog) * 6 / 10);
    const auto result = run(rawlog);
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("roevo-odometry: warning: "), std::string::npos) << result.err;
    EXPECT_NE(summary()["input"]["warning"], "");
    EXPECT_GE(rows().size(), 3u);
    EXPECT_LT(rows().size(), 10u);
}

TEST_F(BadRawlog, RepeatedAndBackwardStampsAreRejected) {
    auto frames = slidingRecording(8);
    frames[3].timestamp = frames[2].timestamp;
    frames[5].timestamp = frames[1].timestamp;
    const auto result = run(writeRawlog(frames));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    ASSERT_EQ(rows().size(), 8u);
    EXPECT_EQ(status(3), "rejected");
    EXPECT_EQ(status(5), "rejected");
    EXPECT_NE(reason(3).find("repeated"), std::string::npos) << reason(3);
    EXPECT_NE(reason(5).find("backward"), std::string::npos) << reason(5);
    EXPECT_EQ(status(7), "ok");
    EXPECT_EQ(readTumTrajectory(output() + "/trajectory.txt").size(), 6u);
}

TEST_F(BadRawlog, ImageFileThatIsGone) {
    const std::string rawlog = writeRawlog(slidingRecording(6));
    std::vector<fs::path> images;
    for (const auto& entry : fs::directory_iterator(folder_ / "r_Images")) images.push_back(entry.path());
    ASSERT_EQ(images.size(), 6u);
    std::sort(images.begin(), images.end());
    fs::remove(images[3]);
    ASSERT_EQ(run(rawlog).exit_code, 0);
    EXPECT_EQ(status(3), "rejected");
    EXPECT_NE(reason(3).find(images[3].filename().string()), std::string::npos) << reason(3);
    expectOthersTracked(3, 6);
}

TEST_F(BadRawlog, ImpossibleDepthScale) {
    auto frames = slidingRecording(3);
    RawlogWriterOptions options;
    options.range_units = 1;  // metres per unit: 12.5 km
    RawlogWriter writer(folder_ / "far.rawlog", camera(), options);
    for (const auto& frame : frames) writer.add(frame.timestamp, frame.depth, frame.colour);
    writer.finish();
    expectError(run(folder_ / "far.rawlog"), 1, kName,
                {"far.rawlog", "depth scale", "5000 times too large", "2.5 m"});
}

TEST_F(BadRawlog, UnknownSensorLabel) {
    expectError(run(writeRawlog(slidingRecording(2)), {"--sensor-label", "LASER"}), 1, kName,
                {"LASER", "RGBD"});
}

}  // namespace
}  // namespace roevo
