// A pose relative to one keyframe and to another: the same place, and how sure that is.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>
#include <vector>

#include "core/support/random_pose.h"
#include "odometry/trajectory.h"

namespace roevo {
namespace {

/// Of small errors, different along each axis and correlated.
Matrix6d randomCovariance(std::mt19937& random) {
    Matrix6d root;
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) root(r, c) = testing::uniform(random, -1e-3, 1e-3);
    return root * root.transpose() + 1e-7 * Matrix6d::Identity();
}

RelativePose randomRelative(std::mt19937& random) {
    return {0, testing::randomPose(random, 2, 1), {randomCovariance(random), {}}};
}

/// With an error of its position and orientation, both along the camera's axes.
Pose perturbed(const RelativePose& pose, std::mt19937& random) {
    std::normal_distribution<double> normal;
    Vector6d white;
    for (int k = 0; k < 6; ++k) white[k] = normal(random);
    const Eigen::LLT<Matrix6d> root(pose.covariance());
    return pose.T_keyframe_camera * poseIncrement(root.matrixL() * white);
}

TEST(RelativePose, AnotherReferenceLeavesTheCameraWhereItIs) {
    std::mt19937 random(121);
    for (int i = 0; i < 50; ++i) {
        const RelativePose pose = randomRelative(random), keyframe = randomRelative(random);
        const RelativePose changed = changeReference(pose, keyframe, 7);
        EXPECT_EQ(changed.keyframe, 7);
        EXPECT_LT((changed.T_keyframe_camera.matrix() -
                   (keyframe.T_keyframe_camera.inverse() * pose.T_keyframe_camera).matrix())
                      .norm(),
                  1e-12);
    }
}

// A frame whose neighbour became the keyframe used to keep the covariance that it had against the old one.
TEST(RelativePose, ItsCovarianceIsThatOfManyDisturbedPoses) {
    std::mt19937 random(122);
    for (int repeat = 0; repeat < 4; ++repeat) {
        const RelativePose pose = randomRelative(random), keyframe = randomRelative(random);
        const RelativePose changed = changeReference(pose, keyframe, 1);
        constexpr int kSamples = 20000;
        Matrix6d sum = Matrix6d::Zero();
        for (int i = 0; i < kSamples; ++i) {
            const Pose T_old_new = perturbed(keyframe, random), T_old_camera = perturbed(pose, random);
            const Pose off = T_old_new.inverse() * T_old_camera;
            const Pose error = changed.T_keyframe_camera.inverse() * off;
            const Eigen::AngleAxisd turn(error.linear());
            Vector6d xi;
            xi << error.translation(), turn.angle() * turn.axis();
            sum += xi * xi.transpose();
        }
        // Errors that are as uncertain as is said are white once they are divided by that
        const Eigen::LLT<Matrix6d> root(changed.covariance());
        const Matrix6d half = root.matrixL().solve(sum / kSamples);
        const Matrix6d white = root.matrixL().solve(half.transpose());
        EXPECT_LT((white - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.05) << white;
    }
}

TEST(RelativePose, WhatIsCommonAddsUpAsTheRestDoes) {
    std::mt19937 random(126);
    for (int i = 0; i < 20; ++i) {
        RelativePose pose = randomRelative(random), keyframe = randomRelative(random);
        const Matrix6d changed = changeReference(pose, keyframe, 1).covariance();
        const Matrix6d composed = compose(keyframe, pose).covariance();
        for (PoseUncertainty* uncertainty : {&pose.uncertainty, &keyframe.uncertainty}) {
            uncertainty->common = 0.7 * uncertainty->independent;
            uncertainty->independent *= 0.3;
        }
        for (const auto& [sum, whole] : {std::pair(changeReference(pose, keyframe, 1), changed),
                                         std::pair(compose(keyframe, pose), composed)}) {
            EXPECT_LT((sum.covariance() - whole).norm(), 1e-12 * whole.norm());
            EXPECT_LT((sum.uncertainty.own() - 0.3 * whole).norm(), 1e-12 * whole.norm());
        }
    }
}

// Frames 1 and 2 of a track, whose rows' motion was a guess, were smoothed away from where they were measured
TEST(RelativePose, WhatNeighboursHaveWrongAlikeIsNotSmoothedAway) {
    const auto farthest = [](const Matrix6d& own, const Matrix6d& common) {
        constexpr int kFrames = 30;
        std::mt19937 random(127);
        std::normal_distribution<double> normal;
        Trajectory trajectory;
        trajectory.beginTrack(0, Pose::Identity(), Matrix6d::Zero());
        std::vector<RelativePose> measured;
        for (int i = 0; i < kFrames; ++i) {
            Pose pose = Pose::Identity();
            pose.translation() = Eigen::Vector3d(0.01 * i + 0.002 * normal(random), 0, 0);
            measured.push_back({0, pose, {own, {}, common}});
            trajectory.addFrame(i / 30., measured.back());
        }
        double most = 0;
        for (int i = 1; i < kFrames; ++i)
            most = std::max(most, (trajectory.frames()[static_cast<std::size_t>(i)].T_world_camera.inverse() *
                                   measured[static_cast<std::size_t>(i)].T_keyframe_camera)
                                      .translation()
                                      .norm());
        return most;
    };
    const Matrix6d exact = 1e-12 * Matrix6d::Identity(), unsure = 4e-6 * Matrix6d::Identity();
    EXPECT_GT(farthest(unsure, exact), 1e-3);
    EXPECT_LT(farthest(exact, unsure), 1e-5);
}

TEST(RelativePose, OfAKnownKeyframeTheCovarianceStaysAsItWas) {
    std::mt19937 random(123);
    const RelativePose pose = randomRelative(random);
    RelativePose keyframe = randomRelative(random);
    keyframe.uncertainty = {};
    EXPECT_LT((changeReference(pose, keyframe, 1).covariance() - pose.covariance()).norm(),
              1e-12 * pose.covariance().norm());
}

TEST(RelativePose, InTheWorldTheReferenceDoesNotMatter) {
    std::mt19937 random(124);
    for (int i = 0; i < 20; ++i) {
        Trajectory trajectory;
        trajectory.beginTrack(0, testing::randomPose(random, 5, 2), randomCovariance(random));
        const RelativePose pose = randomRelative(random), keyframe = randomRelative(random);
        const int id = trajectory.addKeyframe(1, keyframe, {});
        const RelativePose changed = changeReference(pose, keyframe, id);
        EXPECT_LT((trajectory.worldPose(changed).matrix() - trajectory.worldPose(pose).matrix()).norm(),
                  1e-12);
        // The keyframe's own error is in twice, as if they were two: too unsure rather than too sure
        const Matrix6d more = trajectory.worldCovariance(changed) - trajectory.worldCovariance(pose);
        const Eigen::SelfAdjointEigenSolver<Matrix6d> values((more + more.transpose()) / 2);
        EXPECT_GT(values.eigenvalues().minCoeff(), -1e-9 * more.norm());
    }
}

// Of the pose in the world: errors of the keyframe's and of the relative pose.
TEST(RelativePose, TheWorldsCovarianceIsThatOfManyDisturbedPoses) {
    std::mt19937 random(125);
    for (int repeat = 0; repeat < 2; ++repeat) {
        const Pose T_world_keyframe = testing::randomPose(random, 5, 2);
        const RelativePose pose = randomRelative(random);
        const RelativePose of_keyframe{0, Pose::Identity(), {randomCovariance(random), {}}};
        Trajectory trajectory;
        trajectory.beginTrack(0, T_world_keyframe, of_keyframe.covariance());
        const Pose T_world_camera = trajectory.worldPose(pose);
        constexpr int kSamples = 20000;
        Matrix6d sum = Matrix6d::Zero();
        for (int i = 0; i < kSamples; ++i) {
            // Along the world's axes: the position moves, and the orientation turns about it
            const Pose by = perturbed(of_keyframe, random);
            const Pose keyframe(by.rotation() * T_world_keyframe.rotation(),
                                T_world_keyframe.translation() + by.translation());
            const Pose off = keyframe * perturbed(pose, random);
            const Eigen::AngleAxisd turn(Eigen::Matrix3d(off.linear() * T_world_camera.linear().transpose()));
            Vector6d xi;
            xi << off.translation() - T_world_camera.translation(), turn.angle() * turn.axis();
            sum += xi * xi.transpose();
        }
        const Eigen::LLT<Matrix6d> root(trajectory.worldCovariance(pose));
        const Matrix6d half = root.matrixL().solve(sum / kSamples);
        const Matrix6d white = root.matrixL().solve(half.transpose());
        EXPECT_LT((white - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.05) << white;
    }
}

}  // namespace
}  // namespace roevo
