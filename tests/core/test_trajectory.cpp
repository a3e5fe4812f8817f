// What final poses become of frames between keyframes.
#include <gtest/gtest.h>

#include <stdexcept>

#include "odometry/trajectory.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

RelativePose from(int keyframe, const Pose& T_keyframe_camera) {
    return {keyframe, T_keyframe_camera, {}};
}

RelativePose seen(int keyframe, const Pose& pose) {
    return {keyframe, pose, {1e-8 * Matrix6d::Identity(), {}}};
}

int beginTrack(Trajectory& trajectory, double timestamp, const Pose& pose) {
    return trajectory.beginTrack(timestamp, pose, Matrix6d::Zero());
}

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

TEST(Trajectory, NothingIsInterpolatedBetweenTracks) {
    EXPECT_NEAR(foundAgain().frames()[3].T_world_camera.translation().x(), 41, 1e-12);
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

std::vector<int> idsOf(const Correction& correction) {
    std::vector<int> ids;
    for (const auto& [id, motion] : correction.motions) ids.push_back(id);
    return ids;
}

TEST(Trajectory, AJoinedTrackMovesAsAWholeAndSoDoesWhatTheMapSaysOfItLater) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0)));
    beginTrack(trajectory, 1, at(50));
    trajectory.addFrame(1, from(1, at(0)));
    trajectory.addKeyframe(2, from(1, at(1)), {});
    trajectory.addFrame(2, from(2, at(0)));
    EXPECT_EQ(trajectory.beginOfTrack(2), 1);
    const Correction join = trajectory.join(2, from(0, at(3)));  // keyframe 2 is at x = 3
    EXPECT_EQ(idsOf(join), (std::vector<int>{1, 2}));
    EXPECT_EQ(join.places.front().from, 0);
    EXPECT_NEAR(join.motions.begin()->second.translation().x(), -48, 1e-12);
    EXPECT_EQ(trajectory.beginOfTrack(2), 0);
    EXPECT_NEAR(trajectory.frames()[1].T_world_camera.translation().x(), 2, 1e-12);
    EXPECT_NEAR(trajectory.frames()[2].T_world_camera.translation().x(), 3, 1e-12);
    MapUpdate late;  // from before the join, in the old place
    late.keyframe = 2;
    late.poses = {{1, at(50.5)}, {2, at(51.5)}};
    trajectory.apply(late);
    EXPECT_NEAR(trajectory.keyframePose(1).translation().x(), 2.5, 1e-12);
    EXPECT_NEAR(trajectory.keyframePose(2).translation().x(), 3.5, 1e-12);
    EXPECT_EQ(trajectory.addKeyframe(3, from(2, at(1)), {}), 3);
    MapUpdate after;  // of a keyframe that came after the join
    after.keyframe = 3;
    after.poses = {{2, at(3.6)}, {3, at(4.6)}};
    trajectory.apply(after);
    EXPECT_NEAR(trajectory.keyframePose(2).translation().x(), 3.6, 1e-12);
}

TEST(Trajectory, OfTwoTracksThatMeetTheYoungerOneMoves) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    beginTrack(trajectory, 1, at(50));
    trajectory.addKeyframe(2, from(1, at(1)), {});
    trajectory.addKeyframe(3, from(0, at(4)), {});  // found again at keyframe 0
    trajectory.addFrame(3, from(3, at(0)));
    const Correction join = trajectory.join(3, from(2, at(2)));  // and what it shows is seen from keyframe 2
    EXPECT_EQ(idsOf(join), (std::vector<int>{1, 2}));
    EXPECT_EQ(join.places.front().from, 3);
    EXPECT_NEAR(trajectory.keyframePose(2).translation().x(), 2, 1e-12);
    EXPECT_NEAR(trajectory.keyframePose(1).translation().x(), 1, 1e-12);
    EXPECT_NEAR(trajectory.keyframePose(3).translation().x(), 4, 1e-12) << "the camera stays";
    for (int id = 0; id <= 3; ++id) EXPECT_EQ(trajectory.beginOfTrack(id), 0) << id;
    EXPECT_FALSE(trajectory.closeLoop({{3, from(2, at(2))}, {3, from(1, at(3))}}).motions.empty())
        << "all hangs together";
}

TEST(Trajectory, ATrackThatJoinsALaterKeyframeHangsOnAnOlderOne) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    beginTrack(trajectory, 1, at(50));
    trajectory.addKeyframe(2, from(0, at(2)), {});
    trajectory.addKeyframe(3, from(1, at(1)), {});
    trajectory.addFrame(3, from(3, at(0)));
    const Correction join = trajectory.join(3, from(2, at(3)));
    EXPECT_EQ(idsOf(join), (std::vector<int>{1, 3}));
    EXPECT_NEAR(trajectory.keyframePose(3).translation().x(), 5, 1e-12);
    for (int id = 0; id <= 3; ++id) EXPECT_EQ(trajectory.beginOfTrack(id), 0) << id;
    EXPECT_TRUE(trajectory.motionCovariance(0, 0).allFinite());
}

TEST(Trajectory, WhatWasLoadedAndIsHeldStaysInLoops) {
    for (const bool held : {false, true}) {
        KeyframeGraph graph;
        for (int id = 0; id < 3; ++id) {
            graph.keyframes.push_back({id, 100.0 + id, at(id)});
            graph.links.push_back({id - 1, at(id == 0 ? 0 : 1), {1e-4 * Matrix6d::Identity(), {}}});
            graph.covariances.push_back(1e-6 * Matrix6d::Identity());
        }
        Trajectory trajectory;
        trajectory.load(graph, held);
        for (int id = 3; id < 6; ++id) {
            RelativePose step = from(id - 1, at(1.1));
            step.uncertainty.independent = 1e-4 * Matrix6d::Identity();
            trajectory.addKeyframe(id, step, {});
        }
        EXPECT_EQ(trajectory.beginOfTrack(5), 0);
        const Correction correction = trajectory.closeLoop({{4, seen(1, at(3))}, {5, seen(0, at(5))}});
        EXPECT_EQ(correction.motions.size(), held ? 3U : 6U);
        EXPECT_NEAR(trajectory.keyframePose(5).translation().x(), 5, 0.01);
        EXPECT_EQ(trajectory.keyframePose(2).translation().x() == 2, held);
        EXPECT_TRUE(trajectory.frames().empty());
        EXPECT_EQ(trajectory.graph().links[1].keyframe, 0);
        EXPECT_EQ(trajectory.graph().loops.size(), 2U);
    }
}

/// Out along x in ten steps and back, with a step that is told too long; keyframe 20 is where keyframe 0 is.
Trajectory thereAndBack(double error) {
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.addFrame(0, from(0, at(0)));
    for (int i = 1; i <= 20; ++i) {
        RelativePose step{i - 1, at(i <= 10 ? 1 : -1), {1e-6 * Matrix6d::Identity(), {}}};
        step.T_keyframe_camera.translation().y() = error;
        trajectory.addFrame(i, step);
        trajectory.addKeyframe(i, step, {});
    }
    return trajectory;
}

TEST(Trajectory, ALoopSharesOutWhatHasGoneWrong) {
    Trajectory trajectory = thereAndBack(0.01);
    EXPECT_NEAR(trajectory.keyframePose(20).translation().y(), 0.2, 1e-12);
    const Matrix6d before = trajectory.worldCovariance(from(20, Pose()));
    const Correction correction = trajectory.closeLoop({{19, seen(1, Pose())}, {20, seen(0, Pose())}});
    ASSERT_EQ(correction.motions.size(), 21U);
    EXPECT_NEAR(trajectory.keyframePose(20).translation().norm(), 0, 1e-3);
    EXPECT_NEAR((trajectory.keyframePose(19).translation() - trajectory.keyframePose(1).translation()).norm(),
                0, 1e-3);
    for (int id = 0; id <= 20; ++id) {  // two steps in one place, each as wrong as the other way
        EXPECT_LT(std::abs(trajectory.keyframePose(id).translation().y()), 0.08) << id;
        EXPECT_NEAR(trajectory.keyframePose(id).translation().x(), id <= 10 ? id : 20 - id, 0.02) << id;
    }
    EXPECT_NEAR(trajectory.frames()[20].T_world_camera.translation().norm(), 0, 1e-3);
    EXPECT_LT(trajectory.worldCovariance(from(20, Pose())).trace(), before.trace() / 5);

    MapUpdate late;  // from before the loop
    late.keyframe = 20;
    late.poses = {{20, at(0)}};
    late.poses[0].second.translation().y() = 0.21;
    trajectory.apply(late);
    EXPECT_NEAR(trajectory.keyframePose(20).translation().y(), 0.01, 2e-3);
}

TEST(Trajectory, ALoopThatContradictsAnotherMovesNothing) {
    Trajectory trajectory = thereAndBack(0.001);
    ASSERT_FALSE(trajectory.closeLoop({{19, seen(1, Pose())}, {20, seen(0, Pose())}}).motions.empty());
    const Pose before = trajectory.keyframePose(20);
    const Correction wrong = trajectory.closeLoop({{19, seen(10, Pose())}, {20, seen(10, Pose())}});
    EXPECT_TRUE(wrong.motions.empty());
    EXPECT_EQ(trajectory.keyframePose(20).matrix(), before.matrix());
}

TEST(Trajectory, ALoopMovesNoOtherTrack) {
    Trajectory trajectory = thereAndBack(0.01);
    beginTrack(trajectory, 21, at(7));
    const Correction correction = trajectory.closeLoop({{19, seen(1, Pose())}, {20, seen(0, Pose())}});
    EXPECT_EQ(correction.motions.count(21), 0U);
    EXPECT_EQ(correction.motions.count(20), 1U);
    EXPECT_NEAR(trajectory.keyframePose(21).translation().x(), 7, 1e-12);
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

TEST(Trajectory, AfterAJoinWhatWasRecognisedIsBetterKnownThanWhatIsFarFromIt) {
    const auto variances = [](double position, double turn) {
        Vector6d sigmas;
        sigmas << Eigen::Vector3d::Constant(position), Eigen::Vector3d::Constant(turn);
        return Matrix6d(sigmas.cwiseAbs2().asDiagonal());
    };
    Trajectory trajectory;
    beginTrack(trajectory, 0, at(0));
    trajectory.beginTrack(10, at(0), variances(10, 3));
    trajectory.addKeyframe(20, {1, at(10), {variances(1e-3, 1e-5), {}}}, {});
    trajectory.addFrame(20, from(2, at(0)));
    const Matrix6d look = variances(0.01, 0.5 * kDegree);
    trajectory.join(2, {0, at(2), {look, {}}});
    EXPECT_NEAR(trajectory.worldCovariance(from(2, at(0))).trace(), look.trace(), 0.1 * look.trace());
    // Half a degree over 10 m
    const Matrix6d first = trajectory.worldCovariance(from(1, at(0)));
    EXPECT_NEAR(std::sqrt(first(1, 1)), std::hypot(0.01, 10 * 0.5 * kDegree), 0.005);
}

}  // namespace
}  // namespace roevo
