// Where the map is held: after a re-anchoring elsewhere, and far from the world's origin.
#include <gtest/gtest.h>

#include "core/support/mapped_run.h"

namespace roevo {
namespace {

using namespace testing;

Sequence filmed(const std::string& scene) {
    auto options = smallRoom();
    options.scene = scene;
    options.fps = 15;
    return simulate(options, 60);
}

TEST(MappingGauge, TheOldPlaceDoesNotPullTheNewOne) {
    const Sequence here = filmed("livingroom"), there = filmed("corridor");
    Odometry odometry(here.camera, OdometryOptions(), here.start());
    double time = 0;
    const auto feed = [&](RgbdFrame frame) {
        frame.timestamp = (time += kInterval);
        return odometry.processFrame(frame);
    };
    for (const RgbdFrame& frame : here.frames) feed(frame);
    for (int i = 0; i < 30; ++i) feed(black(0));
    Pose T_there = Pose::Identity();
    double worst = 0, largest_correction = 0;
    for (std::size_t i = 0; i < there.frames.size(); ++i) {
        const FrameResult result = feed(there.frames[i]);
        if (i == 0) {
            ASSERT_EQ(result.status, FrameStatus::kInitialised);
            T_there = result.T_world_camera * there.start().inverse();
        }
        worst = std::max(worst, distance(T_there * there.truth[i].T_world_camera, result.T_world_camera));
        largest_correction = std::max(largest_correction, result.map_correction);
    }
    EXPECT_LT(largest_correction, 0.02);
    EXPECT_LT(worst, 0.02);  // as tracking alone
}

TEST(MappingGauge, MappingGoesOnElsewhere) {
    auto options = smallRoom();
    options.scene = "corridor";
    const Sequence there = simulate(options, 30);
    Odometry odometry(room().camera, manyKeyframes(), room().start());
    double time = 0, worst = 0;
    int updates = 0;
    const auto feed = [&](RgbdFrame frame) {
        frame.timestamp = (time += kInterval);
        return odometry.processFrame(frame);
    };
    for (std::size_t i = 0; i < 14; ++i) feed(room().frames[i]);
    for (int i = 0; i < 30; ++i) feed(black(0));
    Pose T_there = Pose::Identity();
    for (std::size_t i = 0; i < there.frames.size(); ++i) {
        const FrameResult result = feed(there.frames[i]);
        if (i == 0) T_there = result.T_world_camera * there.start().inverse();
        worst = std::max(worst, distance(T_there * there.truth[i].T_world_camera, result.T_world_camera));
        updates += i <= 22 && result.map_correction > kMoved ? 1 : 0;
    }
    EXPECT_GT(updates, 2);
    EXPECT_LT(worst, 0.006);
}

TEST(MappingGauge, AStartFarFromTheOriginOnlyMovesTheTrajectory) {
    const Sequence path = backAndForth(50);
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        for (const double far : {1e5, 4e6}) {
            OdometryOptions options = manyKeyframes();
            options.mode = mode;
            Sequence moved = path;
            for (auto& pose : moved.truth) {
                pose.T_world_camera = path.start().inverse() * pose.T_world_camera;
                pose.T_world_camera.translation() += Eigen::Vector3d(far, -far, 10);
            }
            const MappedRun run = runOver(moved, options);
            double worst = 0;
            for (std::size_t i = 0; i < run.final_poses.size(); ++i)
                worst = std::max(worst,
                                 distance(run.final_poses[i].T_world_camera, moved.truth[i].T_world_camera));
            EXPECT_LT(worst, 0.006) << toString(mode) << " " << far;
        }
    }
}

}  // namespace
}  // namespace roevo
