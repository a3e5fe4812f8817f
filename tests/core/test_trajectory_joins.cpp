// Tracks that are joined, loops that are closed, and what is known of poses then.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/support/trajectories.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using namespace testing;

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
    EXPECT_EQ(trajectory.keyframes()[2].track, 1);
    const Correction join = trajectory.join(2, from(0, at(3)));  // keyframe 2 is at x = 3
    EXPECT_EQ(idsOf(join), (std::vector<int>{1, 2}));
    EXPECT_EQ(join.places.front().from, 0);
    EXPECT_NEAR(join.motions.begin()->second.translation().x(), -48, 1e-12);
    EXPECT_EQ(trajectory.beginOfTrack(2), 0);
    EXPECT_EQ(trajectory.keyframes()[2].track, 0);
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

TEST(Trajectory, OfAJoinedTrackThatIsKnownBestWhichWasRecognised) {
    for (const int recognised : {1, 3, 5}) {
        Trajectory trajectory;
        beginTrack(trajectory, 0, at(0));
        beginTrack(trajectory, 1, at(50));
        for (int id = 2; id <= 5; ++id) {
            RelativePose step = from(id - 1, at(1));
            step.uncertainty.independent = 1e-4 * Matrix6d::Identity();
            trajectory.addKeyframe(id, step, {});
        }
        RelativePose place = from(0, at(3));
        place.uncertainty.independent = 1e-6 * Matrix6d::Identity();
        trajectory.join(recognised, place);
        for (int id = 1; id <= 5; ++id) {
            const double variance = trajectory.worldCovariance(from(id, Pose()))(0, 0);
            EXPECT_NEAR(variance, 1e-6 + 1e-4 * std::abs(id - recognised), 1e-9)
                << id << " of " << recognised;
        }
    }
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
