// Pose graphs: against the truth where constraints are exact, against Ceres where they are not.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/support/random_pose.h"
#include "mapping/pose_graph.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr int kPoses = 12;

Pose moved(const Pose& pose, const Vector6d& step) {
    return pose * poseIncrement(step);
}

struct Ring {
    std::vector<Pose> truth, start;
    std::vector<PoseConstraint> constraints;

    /// @param noise  of the constraints, m and rad
    explicit Ring(std::mt19937& random, double noise) {
        const auto vector = [&](double scale) {
            return Vector6d(Vector6d::NullaryExpr([&] { return testing::uniform(random, -scale, scale); }));
        };
        for (int i = 0; i < kPoses; ++i) truth.push_back(moved(Pose(), vector(1)));
        for (int i = 0; i < kPoses; ++i) {
            PoseConstraint c;
            c.from = i;
            c.to = (i + 1) % kPoses;
            const auto at = [&](int k) { return truth[static_cast<std::size_t>(k)]; };
            c.T_from_to = moved(at(c.from).inverse() * at(c.to), vector(noise));
            const Matrix6d root =
                0.01 * Matrix6d::NullaryExpr([&] { return testing::uniform(random, -1, 1); });
            c.covariance = root * root.transpose() + 1e-5 * Matrix6d::Identity();
            constraints.push_back(c);
        }
        start = {truth.front()};  // by the chain, as tracking has it
        for (int i = 0; i + 1 < kPoses; ++i)
            start.push_back(start.back() * constraints[static_cast<std::size_t>(i)].T_from_to);
    }
};

double distance(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Pose apart = a[i].inverse() * b[i];
        worst = std::max({worst, apart.translation().norm(), rotationAngle(apart)});
    }
    return worst;
}

TEST(PoseGraph, ExactConstraintsAreMetFromAnyStart) {
    std::mt19937 random(41);
    for (int k = 0; k < 20; ++k) {
        const Ring ring(random, 0);
        std::vector<Pose> poses = ring.truth;
        for (std::size_t i = 1; i < poses.size(); ++i)
            poses[i] =
                moved(poses[i], Vector6d::NullaryExpr([&] { return testing::uniform(random, -0.2, 0.2); }));
        ASSERT_TRUE(optimisePoseGraph(poses, ring.constraints, 0));
        EXPECT_LT(distance(poses, ring.truth), 1e-6);
        for (const PoseConstraint& c : ring.constraints) EXPECT_LT(contradiction(poses, c), 1e-6);
    }
}

/// The same residual for Ceres, with poses as steps from where they are.
struct CeresResidual {
    PoseConstraint constraint;
    Pose from, to;
    Matrix6d root;  // of the information

    bool operator()(const double* from_step, const double* to_step, double* out) const {
        const Pose a = moved(from, Eigen::Map<const Vector6d>(from_step)),
                   b = moved(to, Eigen::Map<const Vector6d>(to_step));
        const Pose error = constraint.T_from_to.inverse() * a.inverse() * b;
        const Eigen::AngleAxisd turn(error.rotation());
        Vector6d e;
        e << error.linear().transpose() * error.translation(), turn.angle() * turn.axis();
        Eigen::Map<Vector6d> result(out);
        result = root * e;
        return true;
    }
};

TEST(PoseGraph, AgreesWithCeres) {
    std::mt19937 random(42);
    for (int k = 0; k < 5; ++k) {
        const Ring ring(random, 0.02);
        std::vector<Pose> poses = ring.start;
        ASSERT_TRUE(optimisePoseGraph(poses, ring.constraints, 0));

        std::vector<Vector6d> steps(kPoses, Vector6d::Zero());
        ceres::Problem problem;
        for (const PoseConstraint& c : ring.constraints) {
            const Eigen::LLT<Matrix6d> information((c.covariance + 1e-12 * Matrix6d::Identity()).inverse());
            const auto from = static_cast<std::size_t>(c.from), to = static_cast<std::size_t>(c.to);
            problem.AddResidualBlock(
                new ceres::NumericDiffCostFunction<CeresResidual, ceres::CENTRAL, 6, 6, 6>(
                    new CeresResidual{c, ring.start[from], ring.start[to], information.matrixU()}),
                nullptr, steps[from].data(), steps[to].data());
        }
        problem.SetParameterBlockConstant(steps[0].data());
        ceres::Solver::Options options;
        options.max_num_iterations = 200;
        options.function_tolerance = 1e-14;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        std::vector<Pose> theirs;
        for (std::size_t i = 0; i < steps.size(); ++i) theirs.push_back(moved(ring.start[i], steps[i]));
        EXPECT_GT(distance(poses, ring.start), 0.005) << "or the test asks for nothing";
        // Steps of a small error enter as they are, of 2 cm and a degree that is not quite exact
        EXPECT_LT(distance(poses, theirs), 0.03 * distance(poses, ring.start));
    }
}

TEST(PoseGraph, AConstraintThatContradictsAllElseIsToldByItsContradiction) {
    std::mt19937 random(43);
    const Ring ring(random, 0);
    PoseConstraint across{2, 8, ring.truth[2].inverse() * ring.truth[8], 1e-4 * Matrix6d::Identity()};
    for (const bool wrong : {false, true}) {
        if (wrong) across.T_from_to.translation().x() += 1;
        std::vector<PoseConstraint> constraints = ring.constraints;
        constraints.push_back(across);
        std::vector<Pose> poses = ring.truth;
        ASSERT_TRUE(optimisePoseGraph(poses, constraints, 0));
        if (wrong)
            EXPECT_GT(contradiction(poses, across), 50);
        else
            EXPECT_LT(contradiction(poses, across), 1e-6);
    }
}

TEST(PoseGraph, WhatNoConstraintNamesStays) {
    std::mt19937 random(44);
    Ring ring(random, 0.01);
    std::vector<Pose> poses = ring.start;
    poses.push_back(ring.truth[3]);
    ASSERT_TRUE(optimisePoseGraph(poses, ring.constraints, 5));
    EXPECT_TRUE(poses.back().isApprox(ring.truth[3]));
    for (std::size_t id = 0; id <= 5; ++id)
        EXPECT_EQ(poses[id].matrix(), ring.start[id].matrix()) << "the fixed one and all before it";
    EXPECT_FALSE(poses[6].isApprox(ring.start[6]));
}

}  // namespace
}  // namespace roevo
