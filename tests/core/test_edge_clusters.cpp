// Covariance by edges: against leaving each edge out in fact, and against errors that edges share.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <random>

#include "core/support/random_pose.h"
#include "odometry/trajectory.h"
#include "tracking/gauss_newton.h"

namespace roevo {
namespace {

constexpr int kEdges = 12, kPoints = 15;

/// Points that see the pose across a direction each, one edge after the other.
struct Scene {
    struct Point {
        Eigen::Vector3d place, normal;
        double residual = 0;
        int edge = 0;
    };
    std::vector<Point> points;

    explicit Scene(std::mt19937& random, int edges = kEdges) {
        for (int e = 0; e < edges; ++e) {
            const Eigen::Vector3d centre(testing::uniform(random, -2, 2), testing::uniform(random, -2, 2),
                                         testing::uniform(random, 1, 4));
            const Eigen::Vector3d normal =
                Eigen::Vector3d::NullaryExpr([&] { return testing::uniform(random, -1, 1); }).normalized();
            for (int k = 0; k < kPoints; ++k) {
                const Eigen::Vector3d off =
                    Eigen::Vector3d::NullaryExpr([&] { return testing::uniform(random, -0.2, 0.2); });
                points.push_back({centre + off, normal, 0, e});
            }
        }
    }
    /// Errors that the points of an edge share, and of their own.
    void disturb(std::mt19937& random, double shared, double own) {
        std::normal_distribution<double> normal;
        std::vector<double> of_edge(points.size());
        for (double& value : of_edge) value = shared * normal(random);
        for (Point& point : points)
            point.residual = of_edge[static_cast<std::size_t>(point.edge)] + own * normal(random);
    }
    /// @param without  an edge that is left out
    PoseSystem system(double weight, EdgeClusters* clusters = nullptr, int without = -1) const {
        PoseSystem sum;
        for (const Point& point : points) {
            if (point.edge == without) continue;
            Vector6d row;
            row << point.normal, point.place.cross(point.normal);
            sum.hessian += weight * row * row.transpose();
            sum.gradient += weight * point.residual * row;
            if (clusters == nullptr) continue;
            const Eigen::Vector3f n = point.normal.cast<float>();
            const auto w = static_cast<float>(weight), r = static_cast<float>(weight * point.residual);
            clusters->add(static_cast<std::size_t>(point.edge),
                          {w * n.x() * n.x(), w * n.x() * n.y(), w * n.x() * n.z(), w * n.y() * n.y(),
                           w * n.y() * n.z(), w * n.z() * n.z()},
                          {r * n.x(), r * n.y(), r * n.z()}, point.place);
        }
        return sum;
    }
};

std::vector<std::int32_t> numbers(int edges) {
    std::vector<std::int32_t> clusters;
    for (int e = 0; e < edges; ++e) clusters.push_back(10 + e);
    return clusters;
}

TEST(EdgeClusters, AnInfluenceIsWhatThePoseMovesByWithoutTheEdge) {
    std::mt19937 random(301);
    Scene scene(random);
    scene.disturb(random, 0.01, 0.003);
    EdgeClusters clusters;
    const auto ids = numbers(kEdges);
    clusters.start(ids);
    const PoseSystem all = scene.system(1, &clusters);
    const PoseUncertainty found = clusters.uncertainty(all, 1);
    ASSERT_EQ(found.influences.size(), static_cast<std::size_t>(kEdges));
    for (int e = 0; e < kEdges; ++e) {
        const Vector6d without = scene.system(1, nullptr, e).solve();
        const Vector6d moved = std::sqrt((kEdges - 1.0) / kEdges) * (without - all.solve());
        const EdgeInfluence& influence = found.influences[static_cast<std::size_t>(e)];
        EXPECT_EQ(influence.cluster, 10 + e);
        EXPECT_LT((influence.moved - moved).norm(), 1e-4 * moved.norm()) << e;
    }
}

TEST(EdgeClusters, EdgesOfOneNumberAreOneCluster) {
    std::mt19937 random(302);
    Scene scene(random);
    scene.disturb(random, 0.01, 0.003);
    EdgeClusters clusters;
    std::vector<std::int32_t> ids = numbers(kEdges);
    ids[7] = ids[2];
    clusters.start(ids);
    const PoseSystem all = scene.system(1, &clusters);
    EXPECT_EQ(clusters.uncertainty(all, 1).influences.size(), static_cast<std::size_t>(kEdges - 1));
}

// The mean of what is said of many disturbed scenes against how far their poses scatter.
TEST(EdgeClusters, TheCovarianceIsThatOfErrorsThatEdgesShare) {
    std::mt19937 random(303);
    for (const double shared : {0.0, 0.01}) {
        Scene scene(random, 40);
        const auto ids = numbers(40);
        constexpr double kOwn = 0.004;
        constexpr int kSamples = 1500;
        Matrix6d scatter = Matrix6d::Zero(), said = Matrix6d::Zero(), naive = Matrix6d::Zero();
        for (int i = 0; i < kSamples; ++i) {
            scene.disturb(random, shared, kOwn);
            EdgeClusters clusters;
            clusters.start(ids);
            const PoseSystem all = scene.system(1 / (kOwn * kOwn + shared * shared), &clusters);
            const Vector6d step = all.solve();
            const PoseUncertainty uncertainty = clusters.uncertainty(all, 1);
            scatter += step * step.transpose() / kSamples;
            said += (uncertainty.covariance() - uncertainty.independent) / kSamples;
            naive += uncertainty.independent / kSamples;
        }
        const Eigen::LLT<Matrix6d> root(said);
        const Matrix6d half = root.matrixL().solve(scatter);
        const double ratio = root.matrixL().solve(half.transpose()).trace() / 6;
        EXPECT_GT(ratio, 0.6) << shared;  // the jackknife is a little too careful
        EXPECT_LT(ratio, 1.1) << shared;
        if (shared > 0) {
            EXPECT_GT(scatter.trace(), 5 * naive.trace()) << "or the test asks for nothing";
        }
    }
}

TEST(EdgeClusters, WhatNothingObservesIsAsUncertainAsThePrior) {
    for (const int edges : {1, 2}) {
        std::mt19937 random(304);
        Scene scene(random, edges);
        for (auto& point : scene.points) point.normal = Eigen::Vector3d::UnitX();  // all parallel
        scene.disturb(random, 0.001, 0.001);
        EdgeClusters clusters;
        const auto ids = numbers(edges);
        clusters.start(ids);
        PoseSystem all = scene.system(1e6, &clusters);
        constexpr double kSigma = 0.3;
        all.hessian.diagonal().array() += 1 / (kSigma * kSigma);
        const Matrix6d covariance = clusters.uncertainty(all, 1).covariance();
        ASSERT_TRUE(covariance.allFinite());
        EXPECT_GT(covariance(1, 1), 0.9 * kSigma * kSigma) << edges;
        EXPECT_GT(covariance(2, 2), 0.9 * kSigma * kSigma) << edges;
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues().minCoeff(), 0);
    }
}

// Frame after frame of the same edges, all parallel: what they do not tell grows with the motion, and what
// they tell does not become better by being told again.
TEST(EdgeClusters, WhatAPriorTellsIsNotMeasured) {
    std::mt19937 random(306);
    constexpr int kParallel = 6, kFrames = 20;
    constexpr double kMotion = 0.01;  // m and rad, one sigma, from frame to frame
    Scene scene(random, kParallel);
    for (auto& point : scene.points) point.normal = Eigen::Vector3d::UnitX();
    scene.disturb(random, 0.01, 0.001);
    EdgeClusters clusters;
    PosePrior prior;
    const Matrix6d by_motion = kMotion * kMotion * Matrix6d::Identity();
    Matrix6d first, last;
    for (int k = 0; k < kFrames; ++k) {
        prior.errors.independent += by_motion;
        prior.covariance = by_motion;  // narrow: it is to keep the pose where it is
        PriorTerm term(prior);
        clusters.start(numbers(kParallel));
        PoseSystem all = scene.system(1e4, &clusters);
        ASSERT_TRUE(term.linearise({}, all));
        prior.errors = clusters.uncertainty(all, 1, &term);
        last = prior.errors.covariance();
        if (k == 0) first = last;
    }
    EXPECT_NEAR(last(1, 1), kFrames * kMotion * kMotion, 0.02 * kFrames * kMotion * kMotion);
    EXPECT_GT(last(0, 0), first(0, 0)) << "the edges err alike each time";
    EXPECT_LT(last(0, 0), 0.2 * last(1, 1)) << "and tell something";
}

TEST(EdgeClusters, WhatOneEdgeAloneTellsIsNotKnownWithoutAPrior) {
    for (const int edges : {1, 6}) {
        std::mt19937 random(305);
        Scene scene(random, edges);
        for (auto& point : scene.points) {  // only the first sees along x, and turns about y and z
            if (point.edge > 0) point.normal.x() = 0;
            if (edges == 1)
                point.normal = Eigen::Vector3d::NullaryExpr([&] { return testing::uniform(random, -1, 1); });
        }
        scene.disturb(random, 0.001, 0.001);
        EdgeClusters clusters;
        clusters.start(numbers(edges));
        const PoseSystem all = scene.system(1e6, &clusters);
        const Matrix6d covariance = clusters.uncertainty(all, 1).covariance();
        ASSERT_TRUE(covariance.allFinite()) << edges;
        EXPECT_GT(covariance(0, 0), 0.5) << edges;
    }
}

TEST(EdgeClusters, WithNoEdgesThereIsOnlyWhatTheSystemSays) {
    PoseSystem system;
    system.hessian = 4 * Matrix6d::Identity();
    EdgeClusters clusters;
    const std::vector<std::int32_t> none;
    clusters.start(none);
    clusters.add(3, {1, 0, 0, 1, 0, 1}, {1, 1, 1}, Eigen::Vector3d::UnitZ());  // of no edge
    const PoseUncertainty found = clusters.uncertainty(system, 1);
    EXPECT_LT((found.covariance() - 0.25 * Matrix6d::Identity()).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(found.designEffect(), 1);
}

RelativePose step(int keyframe, double influence, std::int32_t cluster) {
    RelativePose pose{keyframe, Pose::Identity(), {1e-10 * Matrix6d::Identity(), {}}};
    Vector6d moved = Vector6d::Zero();
    moved[0] = influence;
    pose.uncertainty.influences.push_back({cluster, moved});
    return pose;
}

TEST(EdgeClusters, TheSameEdgeErrsAlikeFromKeyframeToKeyframe) {
    const auto sigma = [](const RelativePose& pose) { return std::sqrt(pose.covariance()(0, 0)); };
    EXPECT_NEAR(sigma(compose(step(0, 0.01, 1), step(1, 0.01, 1))), 0.02, 1e-6);
    EXPECT_NEAR(sigma(compose(step(0, 0.01, 1), step(1, 0.01, 2))), 0.01 * std::sqrt(2), 1e-6);
    // Between two frames of one keyframe it cancels
    EXPECT_LT(sigma(changeReference(step(0, 0.01, 1), step(0, 0.01, 1), 2)), 1e-4);
}

TEST(EdgeClusters, AnEdgeThatIsOutOfSightErrsOnItsOwnFromThenOn) {
    for (const bool seen_again : {true, false}) {
        Trajectory trajectory;
        trajectory.beginTrack(0, Pose(), Matrix6d::Zero());
        trajectory.addKeyframe(1, step(0, 0.01, 1),
                               seen_again ? std::vector<std::int32_t>{1} : std::vector<std::int32_t>{2});
        const double sigma = std::sqrt(trajectory.worldCovariance(step(1, 0.01, 1))(0, 0));
        EXPECT_NEAR(sigma, seen_again ? 0.02 : 0.01 * std::sqrt(2), 1e-6);
    }
}

TEST(EdgeClusters, MotionBetweenFramesForgetsWhatBothShare) {
    Trajectory trajectory;
    trajectory.beginTrack(0, Pose(), Matrix6d::Identity());
    trajectory.addFrame(0, step(0, 0.01, 1));
    trajectory.addFrame(1, step(0, 0.03, 1));
    trajectory.addKeyframe(2, step(0, 0.02, 1), {1});
    trajectory.addFrame(3, step(1, 0.02, 1));
    EXPECT_NEAR(std::sqrt(trajectory.motionCovariance(0, 1)(0, 0)), 0.02, 1e-6);
    EXPECT_NEAR(std::sqrt(trajectory.motionCovariance(0, 2)(0, 0)), 0.03, 1e-6);
    trajectory.beginTrack(4, Pose(), Matrix6d::Zero());
    trajectory.addFrame(4, step(2, 0, 1));
    EXPECT_FALSE(trajectory.motionCovariance(0, 3).allFinite()) << "another track";
}

}  // namespace
}  // namespace roevo
