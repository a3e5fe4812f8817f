// The 6x6 system: assembling, solving, the prior.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "core/support/random_pose.h"
#include "roevo/tracking/gauss_newton.h"

namespace roevo {
namespace {

kernels::NormalEquations fromMatrix(const Matrix6d& hessian, const Vector6d& gradient) {
    kernels::NormalEquations part{};
    int k = 0;
    for (int r = 0; r < 6; ++r) {
        part.gradient[r] = gradient[r];
        for (int c = r; c < 6; ++c) part.hessian[k++] = hessian(r, c);
    }
    return part;
}

TEST(PoseSystem, AddUnpacksTheUpperTriangleAndSums) {
    std::mt19937 random(71);
    Matrix6d hessian = Matrix6d::Zero();
    PoseSystem system;
    for (int i = 0; i < 3; ++i) {
        const Matrix6d a = Matrix6d::Random();
        const Matrix6d part = a + a.transpose();
        system.add(fromMatrix(part, Vector6d::Constant(i)));
        hessian += part;
    }
    EXPECT_LT((system.hessian - hessian).norm(), 1e-12);
    EXPECT_LT((system.gradient - Vector6d::Constant(3)).norm(), 1e-12);
}

TEST(PoseSystem, SolvesForTheMinusGradient) {
    const Matrix6d a = Matrix6d::Random();
    PoseSystem system;
    system.hessian = a * a.transpose() + Matrix6d::Identity();
    system.gradient = Vector6d::Random();
    EXPECT_LT((system.hessian * system.solve() + system.gradient).norm(), 1e-9);
}

TEST(PoseSystem, SingularGivesNoStepAndNoNan) {
    PoseSystem empty;
    EXPECT_EQ(empty.solve().norm(), 0);
    empty.gradient.setOnes();
    EXPECT_EQ(empty.solve().norm(), 0);

    PoseSystem line;  // only one direction is seen
    line.hessian(2, 2) = 100;
    line.gradient[2] = 50;
    const Vector6d step = line.solve();
    EXPECT_TRUE(step.allFinite());
    EXPECT_LT(step.norm(), 0.5 + 1e-9);

    PoseSystem broken;
    broken.hessian.setIdentity();
    broken.hessian(1, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(broken.solve().norm(), 0);
    broken.hessian.setIdentity();
    broken.gradient[0] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(broken.solve().norm(), 0);
    PoseSystem negative;
    negative.hessian = -Matrix6d::Identity();
    negative.gradient.setOnes();
    EXPECT_EQ(negative.solve().norm(), 0);
}

TEST(PosePrior, AloneItBringsThePoseToItsMean) {
    std::mt19937 random(72);
    for (int i = 0; i < 50; ++i) {
        PosePrior prior{testing::randomPose(random, 1, 0.5), 0.01, 0.02};
        Pose pose = testing::randomPose(random, 0.2, 0.2) * prior.mean;
        for (int step = 0; step < 5; ++step) {
            PoseSystem system;
            system.addPrior(prior, pose);
            pose = poseIncrement(system.solve()) * pose;
        }
        EXPECT_LT((pose.matrix() - prior.mean.matrix()).norm(), 1e-9);
    }
}

TEST(PosePrior, PullsOnlyWhereNothingElseDecides) {
    PoseSystem system;
    for (int k = 0; k < 5; ++k)
        system.hessian(k, k) = 1e9;  // five directions are seen well and are satisfied
    PosePrior prior{Pose::Identity(), 0.05, 0.05};
    Vector6d off = Vector6d::Constant(0.01);
    system.addPrior(prior, poseIncrement(off));
    const Vector6d step = system.solve();
    EXPECT_LT(step.head<5>().norm(), 1e-7);
    EXPECT_NEAR(step[5], -0.01, 1e-4);
}

TEST(PosePrior, WeighsByItsSigmasAndItsWeight) {
    PosePrior prior{Pose::Identity(), 0.1, 0.2};
    PoseSystem system;
    system.addPrior(prior, Pose::Identity(), 5);
    EXPECT_NEAR(system.hessian(0, 0), 500, 1e-9);
    EXPECT_NEAR(system.hessian(5, 5), 125, 1e-9);
    EXPECT_LT(system.gradient.norm(), 1e-12);
}

}  // namespace
}  // namespace roevo
