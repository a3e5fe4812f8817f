// What final poses become of frames between keyframes.
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/support/trajectories.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using namespace testing;

/// Keyframe 0 at x = 0, `count` frames tracked from it that go to x = `length` in even steps, and keyframe 1
/// there, which the map then moves by `correction` along z.
Trajectory walk(int count, double length, double correction) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int i = 0; i < count; ++i) trajectory.addFrame(0.1 * i, from(0, at(length * i / (count - 1))));
    trajectory.addKeyframe(0.1 * (count - 1), from(0, at(length)), {});
    MapUpdate update;
    update.keyframe = 1;
    Pose moved = at(length);
    moved.translation().z() = correction;
    update.poses.emplace_back(1, moved);
    trajectory.apply(update);
    return trajectory;
}

TEST(Trajectory, ACorrectionIsSharedOutEvenlyAlongAnEvenWalk) {
    const auto frames = walk(11, 1.0, 0.02).frames();
    ASSERT_EQ(frames.size(), 11U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Eigen::Vector3d place = frames[i].T_world_camera.translation();
        EXPECT_NEAR(place.z(), 0.002 * static_cast<double>(i), 1e-12) << i;
        EXPECT_NEAR(place.x(), 0.1 * static_cast<double>(i), 1e-12) << i;
    }
}

TEST(Trajectory, FramesGoAlongWithTheirKeyframeWhenItIsTheLast) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0)));
    trajectory.addFrame(0.1, from(0, at(0.3)));
    MapUpdate update;
    update.poses.emplace_back(0, at(5));
    trajectory.apply(update);
    EXPECT_NEAR(trajectory.frames()[1].T_world_camera.translation().x(), 5.3, 1e-12);
}

TEST(Trajectory, NothingIsSharedAcrossALoss) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0.1, from(0, at(0.3)));
    beginTrack(trajectory, 0.2, at(0.4));  // re-anchored: no parent
    MapUpdate update;
    update.keyframe = 1;
    update.poses.emplace_back(1, at(7));
    trajectory.apply(update);
    EXPECT_NEAR(trajectory.frames()[0].T_world_camera.translation().x(), 0.3, 1e-12);
}

TEST(Trajectory, ACameraThatStandsStillDoesNotJitterByItsCorrection) {
    // Half a millimetre of tracking noise; the map moves the next keyframe by 5 mm
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int i = 0; i <= 30; ++i) trajectory.addFrame(0.1 * i, from(0, at(i % 2 == 0 ? 0 : 0.0005)));
    trajectory.addKeyframe(3, from(0, at(0)), {});
    MapUpdate update;
    update.keyframe = 1;
    Pose moved = Pose::Identity();
    moved.translation().z() = 0.005;
    update.poses.emplace_back(1, moved);
    trajectory.apply(update);
    const auto frames = trajectory.frames();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double step =
            frames[i].T_world_camera.translation().z() - frames[i - 1].T_world_camera.translation().z();
        EXPECT_GT(step, -1e-4) << i << ": never back";
        EXPECT_LT(step, 4e-4) << i << ": in small steps";
    }
    EXPECT_NEAR(frames.back().T_world_camera.translation().z(), 0.005, 1e-12);
}

TEST(Trajectory, PosesAreKeptAsTheyWereKnownAtFirst) {
    const Trajectory trajectory = walk(11, 1.0, 0.02);
    ASSERT_EQ(trajectory.live().size(), 11U);
    EXPECT_EQ(trajectory.live().back().T_world_camera.matrix(), at(1).matrix());
    EXPECT_EQ(trajectory.live().back().timestamp, trajectory.frames().back().timestamp);
}

TEST(Trajectory, YoungerKeyframesFollowTheOneTheyWereTrackedFrom) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    EXPECT_EQ(trajectory.addKeyframe(1, from(0, at(1)), {}), 1);
    EXPECT_EQ(trajectory.addKeyframe(2, from(1, at(1)), {}), 2);
    EXPECT_EQ(beginTrack(trajectory, 3, at(10)), 3);
    EXPECT_EQ(trajectory.addKeyframe(4, from(3, at(1)), {}), 4);
    MapUpdate update;  // of keyframe 1, late: 2 to 4 are there already
    update.keyframe = 1;
    update.poses.emplace_back(1, at(1.5));
    trajectory.apply(update);
    EXPECT_NEAR(trajectory.keyframePose(2).translation().x(), 2.5, 1e-12);
    EXPECT_NEAR(trajectory.keyframePose(3).translation().x(), 10, 1e-12) << "no map relates it to 1";
    EXPECT_NEAR(trajectory.keyframePose(4).translation().x(), 11, 1e-12);
}

TEST(Trajectory, FramesWithoutAMeasuredPoseAreInterpolatedInTime) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0)));
    for (const double t : {1.0, 3.0}) trajectory.addFrame(t, from(0, at(-7)), false);
    trajectory.addFrame(4, from(0, at(8)));
    trajectory.addFrame(5, from(0, at(-7)), false);
    auto frames = trajectory.frames();
    EXPECT_NEAR(frames[1].T_world_camera.translation().x(), 2, 1e-12);
    EXPECT_NEAR(frames[2].T_world_camera.translation().x(), 6, 1e-12);
    EXPECT_NEAR(frames[4].T_world_camera.translation().x(), -7, 1e-12) << "no other end is known";
    EXPECT_NEAR(trajectory.live()[1].T_world_camera.translation().x(), -7, 1e-12);
    trajectory.measureAfterwards(3, from(0, at(5)));
    frames = trajectory.frames();
    EXPECT_NEAR(frames[2].T_world_camera.translation().x(), 5, 1e-12);
    EXPECT_NEAR(frames[1].T_world_camera.translation().x(), 5.0 / 3, 1e-12) << "interpolated up to it";
    EXPECT_NEAR(trajectory.live()[2].T_world_camera.translation().x(), -7, 1e-12) << "as it was known then";
    for (const double unknown : {3.5, 9.0})
        EXPECT_THROW(trajectory.measureAfterwards(unknown, from(0, at(5))), std::logic_error);
}

TEST(Trajectory, WhatIsBridgedFollowsTheVelocityAtBothEnds) {
    const auto on_circle = [](double seconds) {  // of 1 m, at 1 rad/s, looking ahead
        return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(seconds, Eigen::Vector3d::UnitZ())),
                    Eigen::Vector3d(std::cos(seconds), std::sin(seconds), 0));
    };
    Trajectory trajectory;
    beginTrack(trajectory, 0, Pose::Identity());
    for (int i = 0; i < 35; ++i) {
        const bool measured = i < 10 || i >= 25;  // 15 frames: a chord is 3.5 cm off
        trajectory.addFrame(i / 30., from(0, measured ? on_circle(i / 30.) : at(-7)), measured);
    }
    for (const StampedPose& pose : trajectory.frames())
        EXPECT_LT((on_circle(pose.timestamp).inverse() * pose.T_world_camera).translation().norm(), 0.01);
}

TEST(Trajectory, ASingleFrameIsNotBentByTheNoiseOfItsNeighbours) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int i = 0; i < 10; ++i)  // 5 mm to and fro; one without a pose
        trajectory.addFrame(
            i / 30., {0, at(i % 2 == 0 ? 0.0025 : -0.0025), {6e-6 * Matrix6d::Identity(), {}}}, i != 5);
    EXPECT_LT(std::abs(trajectory.frames()[5].T_world_camera.translation().x()), 0.003);
}

TEST(Trajectory, ThatTwoStampsNearlyCoincideMakesNoSpeed) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0.005)));
    trajectory.addFrame(1e-6, from(0, at(0)));  // 5 mm of noise: 5 km/s
    for (const double t : {0.5, 1.0, 1.5}) trajectory.addFrame(t, from(0, at(9)), false);
    trajectory.addFrame(2, from(0, at(0)));
    for (const StampedPose& pose : trajectory.frames())
        EXPECT_LT(std::abs(pose.T_world_camera.translation().x()), 0.03) << pose.timestamp;
}

/// Keyframes 0 and 1 of one track, 2 of another, and 3, which was recognised at keyframe 0.
Trajectory foundAgain() {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0)));
    trajectory.addKeyframe(1, from(0, at(1)), {});
    trajectory.addFrame(1, from(1, at(0)));
    beginTrack(trajectory, 2, at(50));
    trajectory.addFrame(2, from(2, at(0)));
    trajectory.addFrame(3, from(2, at(-9)), false);
    trajectory.addKeyframe(4, from(0, at(2)), {});
    trajectory.addFrame(4, from(3, at(0)));
    return trajectory;
}

TEST(Trajectory, WhatWasMeasuredInAnotherTrackIsBentToWhereTheLongestOneHasIt) {
    // Lost from 2 s on in one track, from 6 s on in the other, which went on to 5 m beside it
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (const double t : {0.0, 1.0}) trajectory.addFrame(t, from(0, at(t)));
    trajectory.addFrame(2, from(0, at(-7)), false);
    beginTrack(trajectory, 3, at(50));
    for (const double t : {3.0, 4.0, 4.5, 5.0}) {  // one of them without a pose
        Pose beside = at(t - 3);
        beside.translation().y() = 1 - std::abs(t - 4);
        trajectory.addFrame(t, from(1, t == 4.5 ? at(-9) : beside), t != 4.5);
    }
    trajectory.addFrame(6, from(1, at(-9)), false);
    for (const double t : {7.0, 8.0, 9.0}) trajectory.addFrame(t, from(0, at(t)));
    for (const bool smooth : {false, true}) {
        const std::vector<StampedPose> frames = trajectory.frames(smooth);
        for (const StampedPose& frame : frames) {
            const bool measured = frame.timestamp != 4.5;
            const Eigen::Vector3d& position = frame.T_world_camera.translation();
            EXPECT_NEAR(position.x(), frame.timestamp, measured ? 1e-3 : 0.05) << smooth;
            EXPECT_NEAR(position.y(),
                        frame.timestamp == 4 ? 1
                        : measured           ? 0
                                             : 0.6,
                        measured ? 1e-3 : 0.11)
                << frame.timestamp << ": its own motion stays";
        }
    }
    EXPECT_NEAR(trajectory.live()[3].T_world_camera.translation().x(), 50, 1e-12) << "as it was known then";
}

TEST(Trajectory, WhatIsMeasuredForAMomentInAnotherTrackIsWhatHidTheScene) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int i = 0; i <= 10; ++i) trajectory.addFrame(i / 30., from(0, at(i / 30.)));
    beginTrack(trajectory, 11 / 30., at(50));
    for (int i = 11; i < 20; ++i) trajectory.addFrame(i / 30., from(1, at(i % 2)));  // a hand
    for (int i = 20; i <= 30; ++i) trajectory.addFrame(i / 30., from(0, at(i / 30.)));
    for (const StampedPose& frame : trajectory.frames())
        EXPECT_NEAR(frame.T_world_camera.translation().x(), frame.timestamp, 1e-3);
}

TEST(Trajectory, AMomentInAnotherTrackAtAnEndHangsAtTheLongestOne) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(50));
    for (const double t : {0.0, 0.1}) trajectory.addFrame(t, from(0, at(t)));
    beginTrack(trajectory, 0.2, at(0.2));
    for (int i = 2; i < 9; ++i) trajectory.addFrame(0.1 * i, from(1, at(0.1 * (i - 2))));
    beginTrack(trajectory, 0.9, at(-50));
    for (const double t : {0.9, 1.0}) trajectory.addFrame(t, from(2, at(t - 0.9)));
    const std::vector<StampedPose> frames = trajectory.frames();
    EXPECT_NEAR(frames[1].T_world_camera.translation().x(), 0.2, 1e-3);
    EXPECT_NEAR(frames[0].T_world_camera.translation().x(), 0.1, 1e-3) << "its own motion stays";
    EXPECT_NEAR(frames[9].T_world_camera.translation().x(), 0.8, 1e-3);
    EXPECT_NEAR(frames[10].T_world_camera.translation().x(), 0.9, 1e-3);
    trajectory.addFrame(2.5, from(2, at(1.6)));
    EXPECT_NEAR(trajectory.frames()[9].T_world_camera.translation().x(), -50, 1e-3)
        << "a longer one stays where the map has its edges";
}

TEST(Trajectory, AMomentInAnotherTrackStaysWhereItIsBehindFramesThatWereLost) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int i = 0; i < 7; ++i) trajectory.addFrame(0.1 * i, from(0, at(0.1 * i)));
    trajectory.addFrame(0.7, from(0, at(0.7)), false);
    beginTrack(trajectory, 0.8, at(0.8));
    trajectory.addFrame(0.8, from(1, at(0)));
    for (const StampedPose& frame : trajectory.frames())
        EXPECT_NEAR(frame.T_world_camera.translation().x(), frame.timestamp, 1e-3);
}

TEST(Trajectory, ATrackThatIsElsewhereTooStaysWhole) {
    Trajectory trajectory;  // which comes home at its end
    beginTrack(trajectory, 0, at(0));
    for (const double t : {0.0, 0.1, 0.2}) trajectory.addFrame(t, from(0, at(t)));
    beginTrack(trajectory, 0.3, at(50));
    for (int i = 3; i < 9; ++i) trajectory.addFrame(0.1 * i, from(1, at(0.1 * i)));
    trajectory.addFrame(0.9, from(0, at(0.9)));
    const std::vector<StampedPose> frames = trajectory.frames();
    for (const std::size_t k : {0U, 1U, 2U, 9U})
        EXPECT_NEAR(frames[k].T_world_camera.translation().x(), frames[k].timestamp, 1e-3);
}

TEST(Trajectory, TheWorldIsThatOfAMapThatWasLoaded) {
    Trajectory map;
    beginTrack(map, -9, at(0));
    Trajectory trajectory;
    trajectory.load(map.graph(), false);
    beginTrack(trajectory, 0, at(50));
    for (int i = 0; i < 6; ++i) trajectory.addFrame(0.1 * i, from(1, at(0.1 * i)));
    trajectory.addFrame(0.6, from(0, at(0.6)));  // recognised in the map
    trajectory.addFrame(0.7, from(0, at(0.7)));
    const std::vector<StampedPose> frames = trajectory.frames();
    for (const std::size_t k : {6U, 7U})
        EXPECT_NEAR(frames[k].T_world_camera.translation().x(), frames[k].timestamp, 1e-3);
    EXPECT_NEAR(frames[0].T_world_camera.translation().x(), 0.1, 1e-3) << "a moment before";
}

TEST(Trajectory, MotionIsKnownBetweenAllFramesOfATrack) {
    const Trajectory trajectory = foundAgain();
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 4}, {1, 4}, {4, 1}, {2, 3}})
        EXPECT_TRUE(
            trajectory.motionCovariance(static_cast<std::size_t>(a), static_cast<std::size_t>(b)).allFinite())
            << a << " " << b;
    for (const auto& [a, b] : {std::pair{0, 2}, {2, 4}, {1, 3}})
        EXPECT_FALSE(
            trajectory.motionCovariance(static_cast<std::size_t>(a), static_cast<std::size_t>(b)).allFinite())
            << a << " " << b;
}

TEST(Trajectory, WhatIsSeenAgainIsAsWellKnownAsItWasThen) {
    const auto variance = [](double sigma) -> Matrix6d { return sigma * sigma * Matrix6d::Identity(); };
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    for (int id = 1; id <= 5; ++id) {  // there and back
        RelativePose pose = from(id - 1, at(id < 3 ? 0.5 : -0.4));
        pose.uncertainty.independent = variance(0.01);
        trajectory.addKeyframe(id, pose, {});
    }
    trajectory.addFrame(0, from(0, at(0)));
    trajectory.addFrame(5.5, from(5, at(0)));
    const auto sigma = [&](int id) { return std::sqrt(trajectory.worldCovariance(from(id, at(0)))(0, 0)); };
    const double drifted = sigma(4);
    EXPECT_NEAR(sigma(5), std::sqrt(5.) * 0.01, 0.005);

    MapUpdate update;
    update.keyframe = 5;
    WindowPosterior seen{4, 0, {}, 0.25 * Matrix6d::Identity()};
    seen.uncertainty.independent = variance(0.002);
    update.posterior = seen;
    trajectory.apply(update);
    EXPECT_NEAR(sigma(5), std::hypot(0.002, 0.25 * drifted), 1e-4);
    EXPECT_EQ(sigma(4), drifted) << "it is told of the newest only";
    EXPECT_NEAR(std::sqrt(trajectory.motionCovariance(0, 1)(0, 0)), sigma(5), 1e-6)
        << "motions between places are known no worse than the places";

    // What is tracked from it follows; what tells less than was known changes nothing
    RelativePose next = from(5, at(0.1));
    next.uncertainty.independent = variance(0.01);
    trajectory.addKeyframe(6, next, {});
    const double known = sigma(6);
    EXPECT_NEAR(known, std::hypot(sigma(5), 0.01), 1e-4);
    update.keyframe = 6;
    update.posterior->uncertainty.independent = variance(1);
    trajectory.apply(update);
    EXPECT_EQ(sigma(6), known);
}

TEST(Trajectory, AFrameThatWasTrackedBackwardsStaysWithItsKeyframe) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(-1));
    trajectory.addFrame(0, from(0, at(0)));
    trajectory.addFrame(9.9, from(0, at(0)), false);  // lost
    trajectory.addKeyframe(10, from(0, at(1)), {});
    trajectory.addFrame(10, from(1, at(0)));
    trajectory.measureAfterwards(9.9, from(1, at(-0.3)));
    trajectory.addKeyframe(11, from(1, at(0.3)), {});
    trajectory.addFrame(11, from(2, at(0)));
    MapUpdate update;
    update.keyframe = 2;
    update.poses = {{2, at(0.4)}};
    trajectory.apply(update);
    EXPECT_NEAR(trajectory.frames(false)[1].T_world_camera.translation().x(), -0.3, 1e-12);
}

}  // namespace
}  // namespace roevo
