// Mode ba seen from outside: when the map takes effect, what it moves, and that nothing else depends on it.
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "core/support/mapped_run.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using namespace testing;

const Sequence& path() {
    static const Sequence sequence = backAndForth(50);
    return sequence;
}
const MappedRun& reference() {
    static const MappedRun run = runOver(path(), manyKeyframes());
    return run;
}

TEST(OdometryMapping, TheSequenceMapsALot) {
    ASSERT_GE(reference().keyframes.size(), 7U);
    ASSERT_GE(reference().updates(), 5);
    for (std::size_t i = 1; i < reference().results.size(); ++i)
        EXPECT_EQ(reference().results[i].status, FrameStatus::kOk) << reference().results[i].reason;
}

TEST(OdometryMapping, TheMapTakesEffectExactlySoManyFramesLater) {
    for (const int latency : {1, 4, 10}) {
        OdometryOptions options = manyKeyframes();
        options.mapping.latency = latency;
        const MappedRun run = runOver(path(), options);
        std::vector<std::size_t> due, seen;
        for (std::size_t i = 0; i < run.results.size(); ++i) {
            const std::size_t then = i + static_cast<std::size_t>(latency);
            if (run.results[i].new_keyframe && then < run.results.size()) due.push_back(then);
            if (run.results[i].ms.mapping > 0) seen.push_back(i);
        }
        EXPECT_GE(due.size(), 6U);
        EXPECT_EQ(seen, due) << "latency " << latency;
        for (std::size_t i = 0; i < run.results.size(); ++i) {
            const bool effective = i != due.front() && std::count(due.begin(), due.end(), i) > 0;
            EXPECT_EQ(run.results[i].map_correction > kMoved, effective) << "frame " << i;
        }
    }
}

TEST(OdometryMapping, RejectedFramesDoNotCount) {
    OdometryOptions options = manyKeyframes();
    Sequence spoilt;
    spoilt.camera = path().camera;
    spoilt.truth = path().truth;
    for (const RgbdFrame& frame : path().frames) {
        for (int repeat = 0; repeat < 2; ++repeat) spoilt.frames.push_back(frame);  // the same stamp again
    }
    const MappedRun run = runOver(spoilt, options);
    for (std::size_t i = 1; i < run.results.size(); i += 2) {
        EXPECT_EQ(run.results[i].status, FrameStatus::kRejected);
        EXPECT_EQ(run.results[i].map_correction, 0);
        EXPECT_EQ(run.results[i].ms.mapping, 0);
    }
    EXPECT_TRUE(sameBytes(run.final_poses, reference().final_poses));
}

/// In the dark the pose is held: all that moves it is the map.
TEST(OdometryMapping, WhatTheMapMovesIsReportedToTheLastDigit) {
    constexpr int kDark = 6;
    for (const bool joint : {true, false}) {
        OdometryOptions options = manyKeyframes();
        options.mapping.joint_refinement = joint;
        options.loss.max_predicted = 0;
        Odometry odometry(room().camera, options, path().start());
        int moved = 0;
        double time = 0;
        for (const RgbdFrame& original : path().frames) {
            RgbdFrame frame = original;
            frame.timestamp = (time += kInterval);
            FrameResult last = odometry.processFrame(frame);
            ASSERT_TRUE(last.status == FrameStatus::kOk || time == kInterval) << last.reason;
            if (!last.new_keyframe) continue;
            for (int i = 1; i <= kDark; ++i) {
                const FrameResult dark = odometry.processFrame(black(time += kInterval));
                ASSERT_EQ(dark.status, FrameStatus::kLost);
                EXPECT_NEAR(distance(dark.T_world_camera, last.T_world_camera), dark.map_correction, 1e-12);
                if (i != options.mapping.latency) {
                    EXPECT_EQ(difference(dark.T_world_camera, last.T_world_camera), 0) << i;
                }
                moved += dark.map_correction > 1e-5 ? 1 : 0;
                last = dark;
            }
            const KeyframeInfo newest = odometry.keyframes().back();
            if (newest.timestamp < time - (kDark + 0.5) * kInterval) continue;  // the frame before became it
            EXPECT_LT(difference(last.T_world_camera, newest.T_world_camera), 1e-9)
                << "the camera follows it";
        }
        EXPECT_GE(moved, 5);
    }
}

TEST(OdometryMapping, FinalPosesAreSmoothedAndKeyframesStayWhereTheMapHasThem) {
    OdometryOptions options = manyKeyframes();
    options.motion.smooth = false;
    const MappedRun rough = runOver(path(), options);
    const MappedRun& smooth = reference();
    EXPECT_TRUE(sameBytes(smooth.live_poses, rough.live_poses));
    double moved = 0;
    for (std::size_t i = 0; i < smooth.final_poses.size(); ++i) {
        const double by = distance(smooth.final_poses[i].T_world_camera, rough.final_poses[i].T_world_camera);
        moved = std::max(moved, by);
        for (const KeyframeInfo& keyframe : smooth.keyframes)
            if (keyframe.timestamp == smooth.final_poses[i].timestamp) {
                EXPECT_LT(by, 1e-12) << i;
            }
    }
    EXPECT_GT(moved, 1e-5);
    EXPECT_LT(moved, 0.005);
}

TEST(OdometryMapping, WhatWasWrongWithTheMotionToAKeyframeIsSharedOutOverTheFramesBefore) {
    OdometryOptions options = manyKeyframes();
    options.motion.smooth = false;  // that moves frames, too
    const MappedRun run = runOver(path(), options);
    ASSERT_EQ(run.final_poses.size(), run.results.size());
    ASSERT_EQ(run.live_poses.size(), run.results.size());
    double largest = 0, shared_out = 0;
    int alone = 0;
    for (std::size_t i = 0; i < run.results.size(); ++i) {
        EXPECT_EQ(run.final_poses[i].timestamp, run.results[i].timestamp);
        EXPECT_EQ(run.live_poses[i].timestamp, run.results[i].timestamp);
        EXPECT_EQ(difference(run.live_poses[i].T_world_camera, run.results[i].T_world_camera), 0);
        largest =
            std::max(largest, distance(run.final_poses[i].T_world_camera, run.live_poses[i].T_world_camera));
        if (i == 0 || run.results[i].map_correction > kMoved) continue;
        const Pose live = run.live_poses[i - 1].T_world_camera.inverse() * run.live_poses[i].T_world_camera;
        const Pose refined =
            run.final_poses[i - 1].T_world_camera.inverse() * run.final_poses[i].T_world_camera;
        if (run.final_poses[i - 1].timestamp >= run.keyframes.back().timestamp) {
            ++alone;
            EXPECT_LT(difference(live, refined), 1e-9) << i << ": no keyframe follows that would tell";
        } else {
            EXPECT_LT(difference(live, refined), 1e-3) << i << ": never in one jump";
            shared_out += difference(live, refined);
        }
    }
    EXPECT_GT(alone, 0);
    EXPECT_GT(shared_out, 2e-4);
    EXPECT_GT(largest, 2e-4) << "the map moves keyframes, and frames with them";
}

TEST(OdometryMapping, KeyframesAgreeWithTheTrajectory) {
    const MappedRun& run = reference();
    for (std::size_t k = 0; k < run.keyframes.size(); ++k) {
        EXPECT_EQ(run.keyframes[k].id, static_cast<int>(k));
        const auto at = std::find_if(run.final_poses.begin(), run.final_poses.end(), [&](const auto& pose) {
            return pose.timestamp == run.keyframes[k].timestamp;
        });
        ASSERT_NE(at, run.final_poses.end());
        EXPECT_LT(difference(at->T_world_camera, run.keyframes[k].T_world_camera), 1e-9)
            << k << ": also where a frame became a keyframe only later";
    }
    EXPECT_EQ(difference(run.keyframes[0].T_world_camera, path().start()), 0) << "the gauge";
}

TEST(OdometryMapping, AskingInTheMiddleChangesNothing) {
    std::size_t edges = 0;
    const MappedRun asked = runOver(path(), manyKeyframes(), [&](Odometry& odometry) {
        EXPECT_EQ(odometry.trajectory().size(), odometry.liveTrajectory().size());
        odometry.keyframes();
        edges += odometry.map().size() + odometry.keyframeEdges().size();
    });
    EXPECT_GT(edges, 1000U);
    EXPECT_TRUE(sameBytes(asked.final_poses, reference().final_poses));
    EXPECT_TRUE(sameBytes(asked.live_poses, reference().live_poses));
}

TEST(OdometryMapping, EndingEarlyGivesTheLastKeyframeAsEndingLate) {
    // Poses at the end include what would have taken effect later
    int compared = 0;
    for (std::size_t count = 12; count < path().frames.size() && compared < 3; ++count) {
        if (!reference().results[count - 1].new_keyframe) continue;
        Odometry odometry(path().camera, manyKeyframes(), path().start());
        for (std::size_t i = 0; i < count; ++i) (void)odometry.processFrame(path().frames[i]);
        const auto early = odometry.keyframes();
        const auto early_poses = odometry.trajectory();
        EXPECT_GT(
            distance(early_poses.back().T_world_camera, odometry.liveTrajectory().back().T_world_camera),
            1e-6)
            << "the last keyframe is refined, too";
        for (int i = 1; i <= manyKeyframes().mapping.latency; ++i)
            (void)odometry.processFrame(black(early_poses.back().timestamp + i * kInterval));
        const auto late = odometry.keyframes();
        ASSERT_EQ(early.size(), late.size());
        for (std::size_t k = 0; k < early.size(); ++k)
            EXPECT_EQ(difference(early[k].T_world_camera, late[k].T_world_camera), 0) << k;
        ++compared;
    }
    EXPECT_EQ(compared, 3);
}

TEST(OdometryMapping, TheLastPosesAreBetterThanTracked) {
    OdometryOptions tracking = manyKeyframes();
    tracking.mode = Mode::kTracking;
    constexpr int kLast = 3 * kRendered;  // away, back, and away again
    const Sequence longest = backAndForth(kLast);
    const MappedRun tracked = runOver(longest, tracking);
    double with = 0, without = 0;
    int ends = 0;
    for (int end = 14; end <= kLast; end += 4, ++ends) {
        const auto last = static_cast<std::size_t>(end) - 1;
        const Pose& truth = longest.truth[last].T_world_camera;
        const MappedRun run = runOver(backAndForth(end), manyKeyframes());
        with += distance(run.final_poses.back().T_world_camera, truth);
        without += distance(tracked.final_poses[last].T_world_camera, truth);
    }
    RecordProperty("ba_mm", std::to_string(1000 * with / ends));
    RecordProperty("tr_mm", std::to_string(1000 * without / ends));
    EXPECT_LT(with, 0.95 * without);
}

TEST(OdometryMapping, ShortSequencesHaveAllPosesAndAMap) {
    std::size_t second = 1;
    while (!reference().results[second].new_keyframe) ++second;
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}, second + 1}) {
        Odometry odometry(path().camera, manyKeyframes(), path().start());
        for (std::size_t i = 0; i < count; ++i) (void)odometry.processFrame(path().frames[i]);
        const auto poses = odometry.trajectory();
        ASSERT_EQ(poses.size(), count);
        EXPECT_EQ(odometry.liveTrajectory().size(), count);
        const std::size_t keyframes = count > second ? 2 : 1;
        EXPECT_EQ(odometry.keyframes().size(), keyframes);
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_LT(distance(poses[i].T_world_camera, path().truth[i].T_world_camera), 0.005);
        const EdgeMap map = odometry.map();
        EXPECT_GT(map.size(), 20U);
        int confirmed = 0;
        for (const MapEdge& edge : map) {
            confirmed += edge.verdict == EdgeVerdict::kTrue ? 1 : 0;
            for (const auto& point : edge.points) ASSERT_TRUE(point.allFinite());
        }
        EXPECT_EQ(confirmed > 0, keyframes > 1) << "one keyframe confirms nothing";
    }
    Odometry none(path().camera, manyKeyframes());
    EXPECT_TRUE(none.trajectory().empty() && none.keyframes().empty() && none.map().empty() &&
                none.keyframeEdges().empty());
}

/// One run in a thread of its own, which the mapper's inherits the processors from.
MappedRun runOn(const Sequence& sequence, int processors, int cv_threads, bool hurried) {
    MappedRun run;
    std::thread([&] {
        cpu_set_t allowed;
        ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
        cpu_set_t few;
        CPU_ZERO(&few);
        for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&few) < processors; ++cpu) {
            if (CPU_ISSET(cpu, &allowed)) CPU_SET(cpu, &few);
        }
        ASSERT_EQ(sched_setaffinity(0, sizeof few, &few), 0);
        const int usual = cv::getNumThreads();
        cv::setNumThreads(cv_threads);
        run = runOver(sequence, manyKeyframes(), [&](Odometry&) {
            if (!hurried) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        });
        cv::setNumThreads(usual);
    }).join();
    return run;
}

TEST(OdometryMapping, ProcessorsThreadsLoadAndPaceDoNotMatter) {
    const Sequence away = backAndForth(kRendered);
    const MappedRun usual = runOver(away, manyKeyframes());
    ASSERT_GE(usual.updates(), 3);
    for (const int threads : {1, 2, 3, 4}) {
        const bool alone = threads % 2 == 1;
        std::atomic<bool> stop{false};
        std::vector<std::thread> load;
        for (int i = 1; i < threads; ++i) {
            load.emplace_back([&] {
                while (!stop) std::this_thread::yield();
            });
        }
        const MappedRun run = runOn(away, alone ? 1 : 2, threads, threads < 3);
        stop = true;
        for (std::thread& thread : load) thread.join();
        EXPECT_TRUE(sameBytes(run.final_poses, usual.final_poses)) << threads;
        EXPECT_TRUE(sameBytes(run.live_poses, usual.live_poses)) << threads;
        ASSERT_EQ(run.results.size(), usual.results.size());
        for (std::size_t i = 0; i < run.results.size(); ++i) {
            EXPECT_EQ(run.results[i].map_correction, usual.results[i].map_correction);
            EXPECT_EQ((run.results[i].covariance - usual.results[i].covariance).norm(), 0);
        }
    }
}

TEST(OdometryMapping, WithoutWaitingTheMapTakesEffectAsSoonAsItIsReady) {
    OdometryOptions at_once = manyKeyframes(), soon = manyKeyframes();
    at_once.mapping.deterministic = false;
    soon.mapping.latency = 1;
    // Asking for the trajectory waits for the mapper: all is ready with the next frame
    const MappedRun run = runOver(path(), at_once, [](Odometry& odometry) { odometry.trajectory(); });
    const MappedRun next_frame = runOver(path(), soon);
    EXPECT_GE(next_frame.updates(), 5);
    EXPECT_TRUE(sameBytes(run.live_poses, next_frame.live_poses));
    EXPECT_TRUE(sameBytes(run.final_poses, next_frame.final_poses));
    const MappedRun hurried = runOver(path(), at_once);  // when it is ready is up to the threads
    ASSERT_EQ(hurried.final_poses.size(), path().frames.size());
    for (std::size_t i = 0; i < hurried.results.size(); ++i)
        EXPECT_LT(distance(hurried.results[i].T_world_camera, path().truth[i].T_world_camera), 0.01);
}

TEST(OdometryMapping, StartPoseOnlyMovesTheTrajectory) {
    Pose start = Pose::Identity();
    start.translation() = Eigen::Vector3d(30, -20, 10);
    start.setRotation(Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 1, 0.3).normalized()).toRotationMatrix());
    Sequence moved = path(), origin = path();
    for (std::size_t i = 0; i < moved.truth.size(); ++i) {
        origin.truth[i].T_world_camera = path().start().inverse() * path().truth[i].T_world_camera;
        moved.truth[i].T_world_camera = start * origin.truth[i].T_world_camera;
    }
    const MappedRun here = runOver(origin, manyKeyframes()), there = runOver(moved, manyKeyframes());
    EXPECT_EQ(difference(there.keyframes[0].T_world_camera, moved.start()), 0);
    double worst = 0;
    for (std::size_t i = 0; i < here.final_poses.size(); ++i) {
        worst = std::max(worst, difference(start * here.final_poses[i].T_world_camera,
                                           there.final_poses[i].T_world_camera));
    }
    RecordProperty("worst", std::to_string(1e9 * worst) + "e-9");
    EXPECT_LT(worst, 1e-4);
}

TEST(OdometryMapping, AWorldTwiceAsLargeGivesATrajectoryTwiceAsLarge) {
    Sequence large = path();
    OdometryOptions options = manyKeyframes();
    makeTwiceAsLarge(large, options);
    const MappedRun twice = runOver(large, options);
    double worst = 0, turned = 0;
    for (std::size_t i = 0; i < twice.final_poses.size(); ++i) {
        const Pose &a = reference().final_poses[i].T_world_camera, &b = twice.final_poses[i].T_world_camera;
        worst = std::max(worst, (2 * a.translation() - b.translation()).norm());
        turned = std::max(turned, rotationAngle(a.inverse() * b));
    }
    RecordProperty("mm", std::to_string(1000 * worst));
    EXPECT_LT(worst, 1.5e-3);
    EXPECT_LT(turned, 5e-4);
}

TEST(OdometryMapping, GainAndOffsetHardlyMatter) {
    Sequence dim = path();
    for (std::size_t i = 0; i < dim.frames.size(); ++i) {
        const double gain = 0.75 + 0.15 * std::sin(0.3 * static_cast<double>(i));
        dim.frames[i].grey = cv::Mat();  // its own memory
        path().frames[i].grey.convertTo(dim.frames[i].grey, CV_8U, gain, 10);
    }
    const MappedRun run = runOver(dim, manyKeyframes());
    double worst = 0, usual = 0;
    for (std::size_t i = 0; i < run.final_poses.size(); ++i) {
        worst = std::max(worst, distance(run.final_poses[i].T_world_camera, path().truth[i].T_world_camera));
        usual = std::max(usual,
                         distance(reference().final_poses[i].T_world_camera, path().truth[i].T_world_camera));
    }
    RecordProperty("mm", std::to_string(1000 * worst));
    RecordProperty("undimmed_mm", std::to_string(1000 * usual));
    EXPECT_LT(worst, 0.006);
}

// What it gives where noise makes a drift: MappingReuse
TEST(OdometryMapping, ReuseDoesNotHarmWhereNothingDrifts) {
    double end[2] = {};
    std::vector<StampedPose> poses[2];
    for (const bool reuse : {false, true}) {
        OdometryOptions options = manyKeyframes();
        options.mapping.window = 3;
        options.mapping.reuse_keyframes = reuse;
        const MappedRun run = runOver(path(), options);
        poses[reuse ? 1 : 0] = run.final_poses;
        // The last quarter: a single pose is luck
        const std::size_t count = run.final_poses.size(), first = count - count / 4;
        for (std::size_t i = first; i < count; ++i) {
            end[reuse ? 1 : 0] +=
                distance(run.final_poses[i].T_world_camera, path().truth[i].T_world_camera) /
                static_cast<double>(count - first);
        }
        ASSERT_EQ(run.final_poses.size(), path().frames.size());
    }
    RecordProperty("off_mm", std::to_string(1000 * end[0]));
    RecordProperty("on_mm", std::to_string(1000 * end[1]));
    EXPECT_FALSE(sameBytes(poses[0], poses[1]));
    EXPECT_LT(end[1], 0.0012) << "m, with reuse";
    EXPECT_LT(end[0], 0.0012) << "m, without";
}

}  // namespace
}  // namespace roevo
