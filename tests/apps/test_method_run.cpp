// One method's run, fed frame by frame and summed up.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "compare_fakes.h"
#include "compare_program.h"
#include "roevo-compare/run_method.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::FakeMethod;
using test::FakeSource;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class RunOfAMethod : public testing::Test {
  protected:
    MethodRun run(std::size_t first = 0) {
        MethodInfo info;
        info.name = "fake";
        info.label = "Fake";
        info.note = "made up";
        return runMethod(method, info, source, first, folder.path().string());
    }

    // What runMethod() throws, which must be one line.
    std::string fault() {
        try {
            run();
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            return e.what();
        }
        return "nothing was thrown";
    }

    std::vector<std::string> csvLines() const {
        std::istringstream text(readFile(folder / "frames.csv"));
        std::vector<std::string> lines;
        for (std::string line; std::getline(text, line);) lines.push_back(line);
        return lines;
    }

    void expectFault(const std::vector<std::string>& words) {
        const std::string text = fault();
        for (const std::string& word : words)
            EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
        EXPECT_FALSE(fs::exists(folder / "frames.csv")) << "something half-done was left";
    }

    TemporaryFolder folder;
    FakeSource source{6};
    FakeMethod method;
};

TEST_F(RunOfAMethod, SumsUpWhatTheMethodSaid) {
    method.change = [](std::size_t frame, MethodFrame& out) {
        out.stage_ms = {static_cast<double>(frame), 100};
        if (frame == 5) out.tracked = false, out.reason = "lost, with a comma", out.stage_ms = {1e6, 1e6};
    };
    method.stage_names = {"one", "second one"};
    method.background_work = Method::Background{"mapping", 7, 3};
    const MethodRun result = run();
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.method, "fake");
    EXPECT_EQ(result.label, "Fake");
    EXPECT_EQ(result.note, "made up");
    EXPECT_EQ(result.frames, 6u);
    EXPECT_EQ(result.tracked, 5u);
    EXPECT_EQ(result.rejected, 0u);
    ASSERT_EQ(result.stages.size(), 2u);
    EXPECT_EQ(result.stages[0].name, "one");
    EXPECT_EQ(result.stages[0].median, 2) << "0 1 2 3 4, of the tracked frames only";
    EXPECT_EQ(result.stages[0].mean, 2);
    EXPECT_NEAR(result.stages[0].p95, 3.8, 1e-12);
    EXPECT_EQ(result.stages[1].median, 100);
    EXPECT_EQ(result.background, "mapping");
    EXPECT_EQ(result.background_ms, 7);
    EXPECT_GT(result.memory_peak_mb, 1);
    ASSERT_EQ(result.trajectory.size(), 6u) << "the lost frame has a pose, too";
    EXPECT_EQ(result.trajectory[2].timestamp, 1.2);
    EXPECT_EQ(result.trajectory[2].T_world_camera.translation().x(), 0.02);
    EXPECT_EQ(result.scene, "");

    const auto lines = csvLines();
    ASSERT_EQ(lines.size(), 7u);
    EXPECT_EQ(lines[0], "timestamp,tracked,reason,ms_decode,ms_one,ms_second_one,ms_total");
    EXPECT_EQ(lines[2].rfind("1.100000,1,,0.000,1.000,100.000,", 0), 0u) << lines[2];
    EXPECT_EQ(lines[6].rfind("1.500000,0,\"lost, with a comma\",", 0), 0u) << lines[6];
}

TEST_F(RunOfAMethod, DecodingIsNoneOfItsTime) {
    constexpr double kDecoding = 20, kMethod = 5;  // ms
    source.decoding_ms = kDecoding;
    method.change = [](std::size_t, MethodFrame&) { test::work(kMethod); };
    const MethodRun result = run();
    EXPECT_EQ(result.decode.median, kDecoding);
    EXPECT_GE(result.total.median, kMethod);
    // Another program can take the core for a while, but not in most frames of 5 ms
    EXPECT_LT(result.total.median, kDecoding);
    EXPECT_LT(result.cpu_ms_per_frame, kDecoding) << "processor time of decoding is in it";
    EXPECT_GT(result.cpu_ms_per_frame, 0);
}

TEST_F(RunOfAMethod, ProcessorTimeIsThatOfAllThreadsAndOfTheEnd) {
    constexpr double kFrame = 5, kEnd = 60;  // ms
    method.change = [](std::size_t, MethodFrame&) {
        double used = 0;
        std::thread([&] {  // until the clock of this thread says that it did work
            timespec time{};
            do {
                test::work(1);
                clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
                used = 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
            } while (used < kFrame);
        })
            .join();
    };
    const double without_end = run().cpu_ms_per_frame;
    EXPECT_GE(without_end, kFrame);
    source = FakeSource(6);
    method.final_trajectory = []() -> std::optional<std::vector<StampedPose>> {
        const std::clock_t start = std::clock();
        while (1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < kEnd) {
        }
        return std::nullopt;
    };
    EXPECT_GE(run().cpu_ms_per_frame, kFrame + kEnd / 6);
}

TEST_F(RunOfAMethod, FramesThatCannotBeUsedAreRejectedAndTheOthersGoOn) {
    source.frames[2].fault = "cannot read rgb/2.png";
    source.frames[3].timestamp = source.frames[1].timestamp;      // again
    source.frames[4].timestamp = source.frames[1].timestamp - 1;  // backward
    source.damage = "the file ends in the middle";
    const MethodRun result = run();
    EXPECT_EQ(method.seen.size(), 3u);
    EXPECT_EQ(result.frames, 6u);
    EXPECT_EQ(result.rejected, 3u);
    EXPECT_EQ(result.tracked, 3u);
    EXPECT_EQ(result.trajectory.size(), 3u);
    EXPECT_EQ(result.warnings,
              (std::vector<std::string>{"the file ends in the middle",
                                        "3 of 6 frames cannot be used, 1 of them: cannot read rgb/2.png"}));
    const auto lines = csvLines();
    ASSERT_EQ(lines.size(), 7u);
    EXPECT_NE(lines[3].find("rejected: cannot read rgb/2.png"), std::string::npos) << lines[3];
    EXPECT_NE(lines[4].find("rejected: repeated time stamp"), std::string::npos) << lines[4];
    EXPECT_NE(lines[5].find("rejected: time stamp goes backward"), std::string::npos) << lines[5];
}

TEST_F(RunOfAMethod, OneStampInTheFutureCostsThatFrameOnly) {
    source.frames[2].timestamp = source.frames[2].frame.timestamp = 1e9;
    source.frames[4].timestamp = source.frames[4].frame.timestamp = -11644473600;  // MRPT's invalid one
    const MethodRun result = run();
    EXPECT_EQ(method.seen, (std::vector<double>{1, 1.1, 1.3, 1.5}));
    EXPECT_EQ(method.refused_stamps, (std::vector<double>{1e9, -11644473600}));
    EXPECT_EQ(result.rejected, 2u);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("2 of 6 frames cannot be used, 1 of them: time stamp "),
              std::string::npos)
        << result.warnings[0];
}

using LeapingStamps = test::CompareProgram;

TEST_F(LeapingStamps, CostTheFramesThatTheyCostTheOdometry) {
    std::vector<test::TumFrame> recording = test::slidingRecording(12);
    recording[4].timestamp += 1e9;
    for (std::size_t i = 8; i < 12; ++i) recording[i].timestamp += 300;  // the camera paused
    test::writeTumFolder(folder / "clip", recording);
    const auto result = run({folder / "clip"}, {"--methods", "roevo-tr,difodo-240"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const auto alone = test::runProgram(
        "roevo-odometry",
        {"--input", folder / "clip", "--output", folder / "alone", "--set", "odometry.mode=tr", "--quiet"});
    ASSERT_EQ(alone.exit_code, 0) << alone.all();
    EXPECT_EQ(kept("clip", "roevo-tr").rejected, 2u);
    EXPECT_EQ(readFile(runFolder("clip", "roevo-tr") + "/trajectory.txt"),
              readFile(folder / "alone/trajectory.txt"));
    for (const std::string& text : {result.out, readFile(output() + "/table.md")})
        EXPECT_NE(text.find("2 of 12 frames cannot be used, 1 of them: time stamp leaps ahead by "),
                  std::string::npos)
            << text;
}

TEST_F(RunOfAMethod, TakesNoMoreFramesThanWanted) {
    EXPECT_EQ(run(4).frames, 4u);
    EXPECT_EQ(method.seen.size(), 4u);
    SourceFrame fifth;
    ASSERT_TRUE(source.next(fifth)) << "it was decoded for nothing";
    EXPECT_EQ(fifth.timestamp, source.frames[4].timestamp);
}

TEST_F(RunOfAMethod, TellsHowFarItHasCome) {
    std::vector<std::pair<std::size_t, double>> told;
    runMethod(method, {}, source, 4, folder.path().string(),
              [&](std::size_t frames, double share) { told.emplace_back(frames, share); });
    ASSERT_EQ(told.size(), 4u);
    EXPECT_EQ(told[1], std::make_pair(std::size_t{2}, 0.5)) << "of the 4 that are wanted";
    EXPECT_EQ(told[3], std::make_pair(std::size_t{4}, 1.0));
}

TEST_F(RunOfAMethod, FinalPosesCountWhereThereAreSome) {
    method.final_trajectory = [] {
        return std::vector<StampedPose>{{1.0, Pose(Eigen::Translation3d(0, 5, 0))}};
    };
    const MethodRun result = run();
    ASSERT_EQ(result.trajectory.size(), 1u);
    EXPECT_EQ(result.trajectory[0].T_world_camera.translation().y(), 5);
}

TEST_F(RunOfAMethod, WhatItThrowsIsToldWithTheFrame) {
    method.change = [](std::size_t frame, MethodFrame&) {
        if (frame == 3) throw std::logic_error("no such level\nstack: …");
    };
    expectFault({"at frame 4 (1.300000 s)", "no such level"});
    source = FakeSource(6);
    method = FakeMethod();
    method.change = [](std::size_t, MethodFrame&) { throw 42; };
    expectFault({"at frame 1 ", "no std::exception"});
    source = FakeSource(6);
    method = FakeMethod();
    method.change = [](std::size_t, MethodFrame&) { throw std::bad_alloc(); };
    expectFault({"at frame 1 ", "out of memory"});
    source = FakeSource(6);
    method = FakeMethod();
    method.final_trajectory = []() -> std::optional<std::vector<StampedPose>> {
        throw std::runtime_error("the map is broken");
    };
    expectFault({"at the end", "the map is broken"});
}

TEST_F(RunOfAMethod, ItsFrameNumberCountsRejectedFrames) {
    source.frames[0].fault = "unreadable";
    method.change = [](std::size_t, MethodFrame& out) { out.T_world_camera->translation().x() = kNaN; };
    expectFault({"at frame 2 (1.100000 s)", "not a number"});
}

TEST_F(RunOfAMethod, PosesThatAreNotNumbersAreAFailure) {
    struct Case {
        std::function<void(Pose&)> spoil;
        const char* word;
    };
    const Case cases[] = {
        {[](Pose& pose) { pose.translation().z() = kNaN; }, "not a number"},
        {[](Pose& pose) { pose.translation().z() = std::numeric_limits<double>::infinity(); },
         "not a number"},
        {[](Pose& pose) { pose.setRotation(Eigen::Quaterniond(1, kNaN, 0, 0)); }, "not a number"},
    };
    for (const Case& c : cases) {
        source = FakeSource(6);
        method = FakeMethod();
        method.change = [&](std::size_t frame, MethodFrame& out) {
            if (frame == 2) c.spoil(*out.T_world_camera);
        };
        expectFault({"at frame 3 (1.200000 s)", c.word});
        source = FakeSource(6);
        method = FakeMethod();
        method.final_trajectory = [&] {
            std::vector<StampedPose> poses(3);
            for (std::size_t i = 0; i < 3; ++i) poses[i].timestamp = 1 + 0.1 * static_cast<double>(i);
            c.spoil(poses[1].T_world_camera);
            return poses;
        };
        expectFault({"final trajectory", "1.100000 s", c.word});
    }
}

TEST_F(RunOfAMethod, ResultsThatContradictThemselvesAreAFailure) {
    method.change = [](std::size_t frame, MethodFrame& out) {
        if (frame == 1) out.T_world_camera.reset();
    };
    expectFault({"at frame 2 ", "without a pose"});
    source = FakeSource(6);
    method = FakeMethod();
    method.change = [](std::size_t, MethodFrame& out) { out.stage_ms.pop_back(); };
    expectFault({"at frame 1 ", "1 times for 2 stages"});
    source = FakeSource(6);
    method = FakeMethod();
    method.final_trajectory = [] {
        return std::vector<StampedPose>{{2, Pose::Identity()}, {2, Pose::Identity()}};
    };
    expectFault({"do not ascend"});
}

TEST_F(RunOfAMethod, NoPoseAtAllIsAFailureWithTheReason) {
    method.change = [](std::size_t, MethodFrame& out) {
        out.tracked = false;
        out.T_world_camera.reset();
        out.reason = "no texture";
    };
    expectFault({"none of the 6 frames has a pose", "no texture"});
    source = FakeSource(2);
    for (SourceFrame& frame : source.frames) frame.fault = "cannot read it";
    expectFault({"none of the 2 frames", "cannot read it"});
}

TEST_F(RunOfAMethod, ASceneThatFailsCostsOnlyTheScene) {
    method.scene = [](const std::string& path) {
        writeFile(path, "scene");
        return true;
    };
    EXPECT_EQ(run().scene, "map.3Dscene");
    EXPECT_EQ(readFile(folder / "map.3Dscene"), "scene");
    source = FakeSource(6);
    source.damage = "damaged";
    method.scene = [](const std::string&) -> bool { throw std::runtime_error("disk full"); };
    const MethodRun result = run();
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.scene, "");
    EXPECT_EQ(result.warnings, (std::vector<std::string>{"damaged", "no scene: disk full"}));
}

}  // namespace
}  // namespace roevo
