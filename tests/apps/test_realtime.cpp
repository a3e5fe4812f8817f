// roevo-odometry --realtime: frames come by the clock, and what is dropped is said.
#include <chrono>

#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"

namespace roevo {
namespace {

using test::expectError;
using test::ProgramResult;
using test::readFile;
using test::slidingRecording;
using test::TumFrame;

constexpr double kInterval = 1 / 30.0;  // s, of the recordings
constexpr double kSpare = 2.5;          // s, for all that is not tracking on a busy computer

class Realtime : public test::OdometryProgram {
  protected:
    ProgramResult runTimed(const std::vector<TumFrame>& frames, std::vector<std::string> more = {}) {
        more.push_back("--realtime");
        test::writeTumFolder(folder_ / "recording", frames);
        const auto start = std::chrono::steady_clock::now();
        const ProgramResult result = run(folder_ / "recording", more);
        seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }
    /// Rows of dropped frames; they are like all that says of them.
    std::size_t expectDroppedAreSaid(const ProgramResult& result) const {
        std::size_t dropped = 0, with_pose = 0;
        for (const auto& row : rows()) {
            const bool is_dropped = row.at(2).find("dropped: ") == 0;
            EXPECT_EQ(row.at(1) == "rejected", is_dropped) << row.at(1) << " " << row.at(2);
            dropped += is_dropped ? 1 : 0;
            with_pose += row.at(1) == "rejected" ? 0 : 1;
        }
        EXPECT_EQ(summary()["dropped_frames"], dropped);
        EXPECT_EQ(summary()["frames"]["total"], rows().size());
        const std::string line =
            "dropped     " + std::to_string(dropped) + (dropped == 1 ? " frame " : " frames ");
        EXPECT_EQ(result.out.find(line) != std::string::npos, dropped > 0) << result.out;
        for (const char* name : {"/trajectory.txt", "/trajectory_live.txt"})
            EXPECT_EQ(readTumTrajectory(output() + name).size(), with_pose) << name;
        return dropped;
    }
    /// The same view again and again.
    static std::vector<TumFrame> stillAt(const std::vector<double>& stamps) {
        std::vector<TumFrame> frames(stamps.size(), slidingRecording(1).front());
        for (std::size_t i = 0; i < stamps.size(); ++i) frames[i].timestamp = stamps[i];
        return frames;
    }

    double seconds_ = 0;
};

TEST_F(Realtime, ARunTakesAsLongAsItsRecording) {
    constexpr int kFrames = 40;
    const auto result = runTimed(slidingRecording(kFrames));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_GE(seconds_, (kFrames - 1) * kInterval) << "no frame is taken before its time";
    EXPECT_LT(seconds_, (kFrames - 1) * kInterval + kSpare);
    EXPECT_NEAR(summary()["wall_time_s"].get<double>(), seconds_, kSpare);
    EXPECT_EQ(rows().size(), static_cast<std::size_t>(kFrames));
    expectDroppedAreSaid(result);
    EXPECT_NE(readFile(output() + "/config_used.ini").find("deterministic = false"), std::string::npos);
}

TEST_F(Realtime, WithoutTheClockNothingIsDropped) {
    ASSERT_EQ(runFrames(slidingRecording(10)).exit_code, 0);
    EXPECT_EQ(summary()["dropped_frames"], 0);
    EXPECT_NE(readFile(output() + "/config_used.ini").find("deterministic = true"), std::string::npos);
}

TEST_F(Realtime, WhatComesTooFastIsDroppedAndSaid) {
    // A burst that nobody can follow, and then time to catch up
    constexpr int kBurst = 40, kCalm = 6;
    std::vector<double> stamps;
    for (int i = 0; i < kBurst; ++i) stamps.push_back(100 + 1e-4 * i);
    for (int i = 0; i < kCalm; ++i) stamps.push_back(100.5 + i * 0.1);
    for (const std::string mode : {"ba", "tr"}) {
        const auto result = runTimed(stillAt(stamps), {"--mode", mode});
        ASSERT_EQ(result.exit_code, 0) << result.all();
        ASSERT_EQ(rows().size(), stamps.size()) << "dropped frames have rows, too";
        EXPECT_EQ(status(0), "initialised");
        EXPECT_GE(expectDroppedAreSaid(result), static_cast<std::size_t>(kBurst) - 5);
        EXPECT_EQ(status(kBurst - 1), "rejected");
        EXPECT_EQ(status(kBurst + kCalm - 1), "ok") << "it has caught up: " << reason(kBurst + kCalm - 1);
        EXPECT_NE(result.out.find("not done in time"), std::string::npos) << result.out;
        EXPECT_GE(seconds_, stamps.back() - stamps.front());
    }
}

TEST_F(Realtime, AStrayStampIsNotWaitedFor) {
    const std::vector<double> stamps{100, 100.1, 100.2, 1e6, 1e6 + 0.1, 1e6 + 0.2};
    const auto result = runTimed(stillAt(stamps));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_LT(seconds_, 0.4 + kSpare);
    EXPECT_EQ(rows().size(), stamps.size());
}

TEST_F(Realtime, QuietSaysNothingOfDroppedFramesButWritesThem) {
    std::vector<double> stamps;
    for (int i = 0; i < 20; ++i) stamps.push_back(100 + 1e-4 * i);
    for (int i = 0; i < 5; ++i) stamps.push_back(100.5 + i * 0.1);
    const auto result = runTimed(stillAt(stamps), {"--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_GE(summary()["dropped_frames"].get<int>(), 15);
}

TEST_F(Realtime, SkipAndFirstChooseFramesAndTheClockStartsWithTheFirstOfThem) {
    constexpr int kSkipped = 60, kTaken = 15;
    const auto result = runTimed(slidingRecording(150), {"--skip", "60", "--first", "15"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    ASSERT_EQ(rows().size(), static_cast<std::size_t>(kTaken));
    EXPECT_EQ(rows()[0][0], "102.000000");
    EXPECT_EQ(status(0), "initialised");
    EXPECT_GE(seconds_, (kTaken - 1) * kInterval);
    EXPECT_LT(seconds_, (kTaken - 1) * kInterval + kSkipped * kInterval) << "skipped time is not waited for";
    expectDroppedAreSaid(result);
    expectError(run(folder_ / "recording", {"--realtime", "--skip", "151"}), 1, kName,
                {"--skip", "150 frames"});
}

TEST_F(Realtime, ABrokenFrameDoesNotStopTheClock) {
    const auto frames = slidingRecording(12);
    test::writeTumFolder(folder_ / "recording", frames);
    test::writeFile(folder_.path() / "recording" / "rgb" / "0004.png", "no image");
    const auto result = run(folder_ / "recording", {"--realtime"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    ASSERT_EQ(rows().size(), frames.size());
    EXPECT_EQ(status(4), "rejected");
    EXPECT_EQ(reason(4).find("dropped"), std::string::npos) << reason(4);
    EXPECT_EQ(status(0), "initialised");
}

}  // namespace
}  // namespace roevo
