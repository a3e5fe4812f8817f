// Old keyframes take part again: what that is worth where a sensor's noise makes a drift.
#include <gtest/gtest.h>

#include "core/support/mapped_run.h"

namespace roevo {
namespace {

using namespace testing;

constexpr int kAway = 60;  ///< frames

TEST(MappingReuse, TakesBackTheDriftOfASensorsNoise) {
    // Over two walks, because a single one is luck
    double end[2] = {};
    for (const unsigned seed : {1U, 2U}) {
        simulator::SimulationOptions noisy = smallRoom();
        noisy.seed = seed;
        noisy.useKinectNoise();
        const Sequence away = simulate(noisy, kAway);
        Sequence path = away;
        for (int i = kAway - 2; i >= 0; --i) {
            path.frames.push_back(away.frames[static_cast<std::size_t>(i)]);
            path.truth.push_back(away.truth[static_cast<std::size_t>(i)]);
        }
        for (std::size_t i = 0; i < path.frames.size(); ++i)
            path.frames[i].timestamp = path.truth[i].timestamp = 1 + static_cast<double>(i) * kInterval;
        std::vector<StampedPose> poses[2];
        for (const bool reuse : {false, true}) {
            OdometryOptions options = manyKeyframes();
            options.mapping.window = 2;  // with more, little is left to take back
            options.mapping.reuse_keyframes = reuse;
            const MappedRun run = runOver(path, options);
            ASSERT_EQ(run.final_poses.size(), path.frames.size());
            poses[reuse ? 1 : 0] = run.final_poses;
            // The last quarter: a single pose is luck
            const std::size_t count = run.final_poses.size(), first = count - count / 4;
            for (std::size_t i = first; i < count; ++i) {
                end[reuse ? 1 : 0] +=
                    distance(run.final_poses[i].T_world_camera, path.truth[i].T_world_camera) /
                    static_cast<double>(count - first) / 2;
            }
        }
        EXPECT_FALSE(sameBytes(poses[0], poses[1]));
    }
    RecordProperty("off_mm", std::to_string(1000 * end[0]));
    RecordProperty("on_mm", std::to_string(1000 * end[1]));
    EXPECT_LT(end[1], 0.8 * end[0]);
}

TEST(MappingReuse, AllKeyframesTogetherAndFramesThatFollow) {
    const Sequence path = backAndForth(40);
    Odometry odometry(path.camera, manyKeyframes());
    const std::size_t first_half = path.frames.size() / 2;
    for (std::size_t i = 0; i < path.frames.size(); ++i) {
        if (i == first_half) odometry.refineAll();
        const FrameResult result = odometry.processFrame(path.frames[i]);
        EXPECT_NE(result.status, FrameStatus::kLost) << i;
    }
    odometry.refineAll();
    const auto refined = odometry.trajectory();
    ASSERT_EQ(refined.size(), path.frames.size());
    for (std::size_t i = 0; i < refined.size(); ++i) {
        const Pose truth = path.start().inverse() * path.truth[i].T_world_camera;
        EXPECT_LT((refined[i].T_world_camera.translation() - truth.translation()).norm(), 0.005) << i;
    }
    // Whoever asks again gets about the same: all is settled
    odometry.refineAll();
    const auto again = odometry.trajectory();
    for (std::size_t i = 0; i < refined.size(); ++i)
        EXPECT_LT((refined[i].T_world_camera.translation() - again[i].T_world_camera.translation()).norm(),
                  5e-4);
}

TEST(MappingReuse, WithoutAMapOrAFrameThereIsNothingToRefine) {
    const Sequence path = backAndForth(6);
    OdometryOptions options;
    options.mode = Mode::kTracking;
    Odometry odometry(path.camera, options);
    odometry.refineAll();
    for (const RgbdFrame& frame : path.frames) (void)odometry.processFrame(frame);
    const auto before = odometry.trajectory();
    odometry.refineAll();
    const auto after = odometry.trajectory();
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(before[i].T_world_camera.matrix(), after[i].T_world_camera.matrix());
}

}  // namespace
}  // namespace roevo
