// Two recordings joined end to end: of one room they become one map, of different rooms never. The same with
// any number of threads.
#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>

#include "core/support/simulated.h"

namespace roevo {
namespace {

using testing::Sequence;

/// Frames [begin, end) of a simulation, or backwards from `begin`; times go on evenly either way.
void append(const simulator::SimulationOptions& options, int begin, int end, Sequence& out) {
    const simulator::Simulator simulator(options);
    out.camera = simulator.camera();
    const double gap = 12;  // s: where it is now is not known
    double timestamp = out.frames.empty() ? 1 : out.frames.back().timestamp + gap;
    for (int i = begin; i != end; i += begin < end ? 1 : -1, timestamp += 1 / options.fps) {
        const simulator::SimulatedFrame frame = simulator.frame(i);
        out.frames.push_back({timestamp, frame.grey, frame.depth_noisy, cv::Mat()});
        out.truth.push_back({timestamp, frame.T_world_camera});
    }
}

simulator::SimulationOptions room(unsigned seed, double speed) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    options.seed = seed;
    options.speed = speed;
    return options;
}

OdometryOptions denseKeyframes() {
    OdometryOptions options;
    options.keyframe.max_translation = 0.025;  // more of them in less time
    return options;
}

constexpr std::size_t kFirst = 24;  ///< frames of the first recording

/// A room, and the same with another tremor and speed, from further on, backwards.
const Sequence& sameRoom() {
    static const Sequence sequence = [] {
        Sequence out;
        append(room(1, 0.45), 0, kFirst, out);
        append(room(7, 0.8), 99, 75, out);
        return out;
    }();
    return sequence;
}

/// The room, and then a corridor.
const Sequence& otherRooms() {
    static const Sequence sequence = [] {
        Sequence out;
        append(room(1, 0.45), 0, kFirst, out);
        simulator::SimulationOptions elsewhere = room(3, 0.45);
        elsewhere.scene = "corridor";
        append(elsewhere, 0, 16, out);
        return out;
    }();
    return sequence;
}

struct TracksRun {
    std::vector<FrameResult> results;
    std::vector<StampedPose> trajectory, live;
    int found = 0, joined = 0;
};

/// @param frames  of the sequence, the first ones
TracksRun run(const Sequence& sequence, std::size_t frames) {
    Odometry odometry(sequence.camera, denseKeyframes(), sequence.start());
    TracksRun out;
    for (std::size_t i = 0; i < frames; ++i) {
        out.results.push_back(odometry.processFrame(sequence.frames[i]));
        out.found += out.results.back().found_at >= 0 ? 1 : 0;
        out.joined += out.results.back().joined_at >= 0 ? 1 : 0;
    }
    out.trajectory = odometry.trajectory();
    out.live = odometry.liveTrajectory();
    return out;
}

const TracksRun& sameRoomRun() {
    static const TracksRun result = run(sameRoom(), sameRoom().frames.size());
    return result;
}

/// ATE, m.
double ate(const std::vector<StampedPose>& poses, const Sequence& sequence) {
    return evaluate(sequence.truth, poses).ate.translation.rmse;
}

TEST(Kidnapping, OneRoomIsOneMap) {
    const TracksRun& both = sameRoomRun();
    const std::size_t all = sameRoom().frames.size();
    ASSERT_EQ(both.trajectory.size(), all);
    EXPECT_EQ(both.found + both.joined, 1) << "it begins where the first has not been";
    std::size_t known = kFirst;
    while (known < all && both.results[known].status != FrameStatus::kOk) ++known;
    ASSERT_LT(known, all - 10);
    Sequence second;
    append(room(7, 0.8), 99, 75, second);
    const double first = ate(run(sameRoom(), kFirst).trajectory, sameRoom()),
                 alone = ate(run(second, second.frames.size()).trajectory, second);
    std::vector<StampedPose> one_map = both.trajectory;  // without what was interpolated in between
    one_map.erase(one_map.begin() + kFirst, one_map.begin() + static_cast<std::ptrdiff_t>(known));
    EXPECT_LT(ate(one_map, sameRoom()), 2 * std::max(first, alone));
}

TEST(Kidnapping, OtherRoomsStayApart) {
    const TracksRun both = run(otherRooms(), otherRooms().frames.size());
    EXPECT_EQ(both.found, 0);
    EXPECT_EQ(both.joined, 0);
}

/// 14 frames of a corridor, as of something that is held before the camera, in the midst of a room.
TEST(Kidnapping, AMomentElsewhereIsBridgedOnceTheRoomIsSeenAgain) {
    constexpr std::size_t kHidden = 20, kSeenAgain = 34;
    Sequence sequence, hidden_by;
    append(room(1, 0.45), 0, 50, sequence);
    simulator::SimulationOptions corridor = room(3, 0.45);
    corridor.scene = "corridor";
    append(corridor, 0, static_cast<int>(kSeenAgain - kHidden), hidden_by);
    for (std::size_t i = kHidden; i < kSeenAgain; ++i) {
        sequence.frames[i] = hidden_by.frames[i - kHidden];
        sequence.frames[i].timestamp = sequence.truth[i].timestamp;
    }
    const TracksRun both = run(sequence, sequence.frames.size());
    EXPECT_EQ(both.results[kSeenAgain].status, FrameStatus::kOk);
    EXPECT_GE(both.results[kSeenAgain].found_at, 0) << "there is a track of the corridor";
    for (std::size_t i = 0; i < sequence.truth.size(); ++i) {
        const Pose error = sequence.truth[i].T_world_camera.inverse() * both.trajectory[i].T_world_camera;
        EXPECT_LT(error.translation().norm(), i < kHidden || i >= kSeenAgain ? 0.005 : 0.03) << i;
    }
}

TEST(Kidnapping, IsTheSameWithAnyNumberOfThreads) {
    const testing::ThreadsRestored restored;
    for (const int threads : {1, 2, 4}) {
        cv::setNumThreads(threads);
        const TracksRun again = run(sameRoom(), sameRoom().frames.size());
        for (std::size_t i = 0; i < sameRoomRun().trajectory.size(); ++i) {
            ASSERT_EQ(again.trajectory[i].T_world_camera.matrix(),
                      sameRoomRun().trajectory[i].T_world_camera.matrix())
                << threads << " threads, frame " << i;
            ASSERT_EQ(again.live[i].T_world_camera.matrix(), sameRoomRun().live[i].T_world_camera.matrix());
            ASSERT_EQ(again.results[i].covariance, sameRoomRun().results[i].covariance);
        }
    }
}

}  // namespace
}  // namespace roevo
