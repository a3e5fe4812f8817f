// What final poses become of frames between keyframes.
#include <gtest/gtest.h>

#include "odometry/pose_history.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

/// Keyframe 0 at x = 0, `count` frames tracked from it that go to x = `length` in even steps, and keyframe 1
/// there, which the map then moves by `correction` along z.
PoseHistory walk(int count, double length, double correction) {
    PoseHistory history;
    history.addKeyframe({0, 0.0, at(0)}, -1);
    for (int i = 0; i < count; ++i) history.addFrame(0.1 * i, at(length * i / (count - 1)));
    history.addKeyframe({1, 0.1 * (count - 1), at(length)}, 0);
    MapUpdate update;
    update.keyframe = 1;
    Pose moved = at(length);
    moved.translation().z() = correction;
    update.poses.emplace_back(1, moved);
    history.apply(update);
    return history;
}

TEST(PoseHistory, ACorrectionIsSharedOutEvenlyAlongAnEvenWalk) {
    const auto frames = walk(11, 1.0, 0.02).frames();
    ASSERT_EQ(frames.size(), 11U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Eigen::Vector3d place = frames[i].T_world_camera.translation();
        EXPECT_NEAR(place.z(), 0.002 * static_cast<double>(i), 1e-12) << i;
        EXPECT_NEAR(place.x(), 0.1 * static_cast<double>(i), 1e-12) << i;
    }
}

TEST(PoseHistory, FramesGoAlongWithTheirKeyframeWhenItIsTheLast) {
    PoseHistory history;
    history.addKeyframe({0, 0.0, at(0)}, -1);
    history.addFrame(0, at(0));
    history.addFrame(0.1, at(0.3));
    MapUpdate update;
    update.poses.emplace_back(0, at(5));
    history.apply(update);
    EXPECT_NEAR(history.frames()[1].T_world_camera.translation().x(), 5.3, 1e-12);
}

TEST(PoseHistory, NothingIsSharedAcrossALoss) {
    PoseHistory history;
    history.addKeyframe({0, 0.0, at(0)}, -1);
    history.addFrame(0.1, at(0.3));
    history.addKeyframe({1, 0.2, at(0.4)}, -1);  // re-anchored: no parent
    MapUpdate update;
    update.keyframe = 1;
    update.poses.emplace_back(1, at(7));
    history.apply(update);
    EXPECT_NEAR(history.frames()[0].T_world_camera.translation().x(), 0.3, 1e-12);
}

TEST(PoseHistory, ACameraThatStandsStillDoesNotJitterByItsCorrection) {
    // Half a millimetre of tracking noise; the map moves the next keyframe by 5 mm
    PoseHistory history;
    history.addKeyframe({0, 0.0, at(0)}, -1);
    for (int i = 0; i <= 30; ++i) history.addFrame(0.1 * i, at(i % 2 == 0 ? 0 : 0.0005));
    history.addKeyframe({1, 3.0, at(0)}, 0);
    MapUpdate update;
    update.keyframe = 1;
    Pose moved = Pose::Identity();
    moved.translation().z() = 0.005;
    update.poses.emplace_back(1, moved);
    history.apply(update);
    const auto frames = history.frames();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double step =
            frames[i].T_world_camera.translation().z() - frames[i - 1].T_world_camera.translation().z();
        EXPECT_GT(step, -1e-4) << i << ": never back";
        EXPECT_LT(step, 4e-4) << i << ": in small steps";
    }
    EXPECT_NEAR(frames.back().T_world_camera.translation().z(), 0.005, 1e-12);
}

TEST(PoseHistory, WithoutKeyframesPosesAreAsGiven) {
    PoseHistory history;
    history.addFrame(1, at(2));
    EXPECT_EQ(history.frames()[0].T_world_camera.matrix(), at(2).matrix());
}

}  // namespace
}  // namespace roevo
