// Mode tr: older keyframes are tracked against again where they show about the same.
#include <gtest/gtest.h>

#include <set>

#include "core/support/mapped_run.h"

namespace roevo {
namespace {

using namespace testing;

constexpr int kTimesAwayAndBack = 6;  ///< away and back
constexpr int kPath = kTimesAwayAndBack * (kRendered - 1) + 1;

OdometryOptions trackingOnly() {
    OdometryOptions options = manyKeyframes();
    options.mode = Mode::kTracking;
    return options;
}

/// A room that was seen needs no more keyframes, however often the camera comes by.
TEST(FormerReferences, KeyframesDoNotGrowWithTime) {
    const Sequence path = backAndForth(kPath);
    const MappedRun run = runOver(path, trackingOnly());
    std::set<int> last_way;
    for (int i = 0; i < kPath; ++i) {
        const FrameResult& result = run.results[static_cast<std::size_t>(i)];
        ASSERT_TRUE(result.hasPose() || i == 0) << i << ": " << result.reason;
        if (i > kRendered) {
            EXPECT_FALSE(result.new_keyframe) << i;
        }
        if (i > kPath - kRendered) last_way.insert(result.keyframe);
    }
    EXPECT_GT(run.keyframes.size(), 4U) << "else it is no test";
    EXPECT_EQ(last_way.size(), run.keyframes.size()) << "each is the reference again";
}

/// Nor do errors. What a keyframe has wrong is the same every time.
TEST(FormerReferences, ErrorsDoNotGrowWithTime) {
    const Sequence path = backAndForth(kPath);
    const MappedRun run = runOver(path, trackingOnly());
    ASSERT_EQ(run.live_poses.size(), path.frames.size());
    double first = 0, last = 0;
    for (int k = 0; k < 2 * kRendered - 2; ++k) {
        const auto error = [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            const Pose& truth = path.truth[at].T_world_camera;
            return distance(run.live_poses[at].T_world_camera, truth);
        };
        first = std::max(first, error(k));
        last = std::max(last, error(kPath - 1 - k));
    }
    RecordProperty("first_mm", std::to_string(1000 * first));
    RecordProperty("last_mm", std::to_string(1000 * last));
    EXPECT_LT(last, 1.2 * first);
}

/// Where the reference changes, the pose jumps by what was drifted; the result says by how much.
TEST(FormerReferences, ReturningSaysHowFarItMovesTheCamera) {
    Odometry odometry(room().camera, trackingOnly());
    int returns = 0;
    int reference = 0;
    for (const RgbdFrame& frame : backAndForth(kPath).frames) {
        const FrameResult result = odometry.processFrame(frame);
        const bool returned = result.keyframe < reference && !result.new_keyframe;
        returns += returned ? 1 : 0;
        EXPECT_EQ(result.map_correction > 0, result.keyframe != reference && !result.new_keyframe)
            << result.index;
        EXPECT_LT(result.map_correction, 0.003);
        EXPECT_LT(result.map_turn, 0.1 * kDegree);
        reference = result.keyframe;
    }
    EXPECT_GT(returns, 4) << "else it is no test";
}

/// A loss right after a return is mended as any other.
TEST(FormerReferences, AreRecognisedAfterALoss) {
    Sequence path = backAndForth(kPath);
    const int hidden = 2 * kRendered - 2;  // back at the start
    for (int i = hidden; i < hidden + 12; ++i)
        path.frames[static_cast<std::size_t>(i)] = black(path.frames[static_cast<std::size_t>(i)].timestamp);
    const MappedRun run = runOver(path, trackingOnly());
    for (std::size_t i = static_cast<std::size_t>(hidden) + 20; i < path.frames.size(); ++i) {
        ASSERT_TRUE(run.results[i].hasPose()) << i << ": " << run.results[i].reason;
        const Pose& truth = path.truth[i].T_world_camera;
        EXPECT_LT(distance(run.final_poses[i].T_world_camera, truth), 0.01) << i;
    }
}

}  // namespace
}  // namespace roevo
