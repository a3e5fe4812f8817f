// Increments, interpolation and cross products of poses.
#include <gtest/gtest.h>

#include "core/support/random_pose.h"

namespace roevo {
namespace {

using testing::difference;
using testing::randomPose;
using testing::uniform;

TEST(Se3, IncrementOfZeroIsIdentity) {
    EXPECT_EQ(difference(poseIncrement(Vector6d::Zero()), Pose::Identity()), 0);
    Vector6d tiny = Vector6d::Constant(1e-15);
    EXPECT_TRUE(poseIncrement(tiny).isFinite());
}

TEST(Se3, IncrementRotatesByRodriguesAndMovesByTheTranslation) {
    std::mt19937 random(61);
    for (int i = 0; i < 200; ++i) {
        Vector6d xi;
        for (int k = 0; k < 6; ++k) xi[k] = uniform(random, -2, 2);
        const Pose pose = poseIncrement(xi);
        EXPECT_LT((pose.translation() - xi.head<3>()).norm(), 1e-15);
        const Eigen::Vector3d phi = xi.tail<3>();
        const double angle = phi.norm();
        const Eigen::Matrix3d k = skew(phi / angle);  // Eq. (21)
        const Eigen::Matrix3d expected =
            Eigen::Matrix3d::Identity() + std::sin(angle) * k + (1 - std::cos(angle)) * k * k;
        EXPECT_LT((pose.linear() - expected).norm(), 1e-12);
        EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
        Vector6d back = Vector6d::Zero();
        back.tail<3>() = -phi;
        EXPECT_LT((poseIncrement(back).linear() * pose.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    }
}

TEST(Se3, SmallIncrementMovesAPointByItsJacobian) {
    std::mt19937 random(62);
    const Eigen::Vector3d p(0.4, -0.7, 2.2);
    for (int k = 0; k < 6; ++k) {
        Vector6d xi = Vector6d::Zero();
        xi[k] = 1e-6;
        const Eigen::Vector3d numeric = (poseIncrement(xi) * p - poseIncrement(-xi) * p) / 2e-6;
        Eigen::Matrix<double, 3, 6> jacobian;
        jacobian << Eigen::Matrix3d::Identity(), -skew(p);
        EXPECT_LT((numeric - jacobian.col(k)).norm(), 1e-8);
    }
}

TEST(Se3, SkewIsTheCrossProduct) {
    const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
    EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-14);
}

TEST(Se3, InterpolationMeetsItsEndsAndIsLinearInBetween) {
    std::mt19937 random(63);
    for (int i = 0; i < 100; ++i) {
        const Pose a = randomPose(random, 2, 1.5), b = a * randomPose(random, 0.3, 0.4);
        EXPECT_LT(difference(interpolate(a, b, 0), a), 1e-12);
        EXPECT_LT(difference(interpolate(a, b, 1), b), 1e-12);
        const Pose half = interpolate(a, b, 0.5);
        EXPECT_NEAR(rotationAngle(a.inverse() * half), rotationAngle(a.inverse() * b) / 2, 1e-9);
        EXPECT_LT((half.translation() - (a.translation() + b.translation()) / 2).norm(), 1e-12);
        // Extrapolating by two is going on as before
        const Pose twice = interpolate(a, b, 2);
        const Eigen::Matrix3d turn = b.linear() * a.linear().transpose();
        EXPECT_LT((twice.linear() - turn * b.linear()).norm(), 1e-9);
    }
}

TEST(Se3, RotationAngle) {
    for (const double angle : {0.0, 1e-4, 0.3, 1.5, 3.0}) {
        Vector6d xi = Vector6d::Zero();
        xi.tail<3>() = angle * Eigen::Vector3d(1, -1, 0.3).normalized();
        EXPECT_NEAR(rotationAngle(poseIncrement(xi)), angle, 1e-9);
    }
}

double offRigid(const Pose& pose) {
    return (pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm() +
           std::abs(pose.linear().determinant() - 1);
}

// What a map does to keyframes that hang on each other: a chain of inverses and products, in which an error
// of rounding that is not taken out doubles with every link.
TEST(Pose, StaysRigidThroughAnyChain) {
    std::mt19937 random(64);
    Pose chained = randomPose(random, 1, 1), link = randomPose(random, 1, 1);
    for (int i = 0; i < 20000; ++i) {
        const Pose moved = chained * link;
        link = chained.inverse() * moved * link.inverse() * link;
        chained = moved * chained.inverse() * chained;
        ASSERT_LT(offRigid(chained), 1e-14) << i;
        ASSERT_LT(offRigid(link), 1e-14) << i;
    }
    EXPECT_TRUE(chained.isFinite());
}

TEST(ImageMotion, DoesNotDependOnWhereTheWorldBegins) {
    const Pose T_a_b = poseIncrement((Vector6d() << 0.002, 0, 0, 0, 0.0035, 0).finished());
    std::mt19937 random(67);
    for (const double distance : {0., 3., 30., 300.}) {
        const Pose T_a_world = randomPose(random, distance, 3);
        EXPECT_NEAR(imageMotion(T_a_world, T_a_b.inverse() * T_a_world, 525, 2), 525 * (0.0035 + 0.001), 1e-6)
            << distance;
    }
}

TEST(Pose, InverseIsExactlyTheTransposedRotation) {
    std::mt19937 random(65);
    for (int i = 0; i < 100; ++i) {
        const Pose pose = randomPose(random, 10, 3);
        EXPECT_EQ(pose.inverse().linear(), pose.linear().transpose());
        EXPECT_LT(((pose.inverse() * pose).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-13);
        EXPECT_LT(((pose * pose).matrix() - pose.matrix() * pose.matrix()).norm(), 1e-13);
    }
}

TEST(Pose, TakesTheRotationNextToAMatrixThatIsNone) {
    std::mt19937 random(66);
    Eigen::Isometry3d pose = randomPose(random, 1, 1).isometry();
    const Eigen::Matrix3d clean = pose.linear();
    pose.linear() += 1e-6 * Eigen::Matrix3d::Random();
    EXPECT_LT(offRigid(pose), 1e-14);
    EXPECT_LT((Pose(pose).linear() - clean).norm(), 1e-5);
}

TEST(Pose, SaysWhereItIsNotFinite) {
    Pose pose;
    EXPECT_TRUE(pose.isFinite());
    pose.translation().y() = std::nan("");
    EXPECT_FALSE(pose.isFinite());
    EXPECT_FALSE(Pose(Eigen::Quaterniond(std::nan(""), 0, 0, 0), Eigen::Vector3d::Zero()).isFinite());
}

}  // namespace
}  // namespace roevo
