// Whether covariances are true is told right: Gaussian errors of a known covariance.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <utility>

#include "core/support/random_pose.h"
#include "evaluation/association.h"
#include "evaluation/nees.h"

namespace roevo {
namespace {

using testing::randomPose;

constexpr int kSamples = 6000;

class Nees : public ::testing::Test {
  protected:
    Vector6d normal() {
        Vector6d values;
        for (double& value : values) value = normal_(random_);
        return values;
    }
    /// Millimetres and milliradians, correlated.
    Matrix6d someCovariance() {
        Matrix6d factor;
        for (int i = 0; i < 6; ++i) factor.col(i) = 1e-3 * normal();
        return factor * factor.transpose() + 1e-6 * Matrix6d::Identity();
    }
    /// Errs by (position, orientation) along the axes of the camera itself.
    static Pose moved(const Pose& pose, const Vector6d& error) {
        Pose out = pose * poseIncrement((Vector6d() << 0, 0, 0, error.tail<3>()).finished());
        out.translation() = pose.translation() + pose.linear() * error.head<3>();
        return out;
    }

    std::mt19937 random_{11};
    std::normal_distribution<double> normal_;
};

TEST_F(Nees, IsOneAndNinetyFivePercentWhereTheCovarianceIsRight) {
    std::vector<JudgedMotion> right, half, wrong;
    for (int i = 0; i < kSamples; ++i) {
        const Matrix6d covariance = someCovariance();
        const Pose truth = randomPose(random_, 2, 1);
        const Pose estimate = moved(truth, covariance.llt().matrixL() * normal());
        right.push_back(judgeMotion(truth, estimate, covariance).value());
        half.push_back(judgeMotion(truth, estimate, covariance / 4).value());
        wrong.push_back(judgeMotion(truth, estimate, someCovariance()).value());
    }
    const NeesStatistics statistics = neesStatistics(right);
    EXPECT_EQ(statistics.count, static_cast<std::size_t>(kSamples));
    EXPECT_NEAR(statistics.mean.nees, 1, 0.03);
    EXPECT_NEAR(statistics.mean.nees_translation, 1, 0.04);
    EXPECT_NEAR(statistics.mean.nees_rotation, 1, 0.04);
    EXPECT_NEAR(statistics.inside, 0.95, 0.01);
    EXPECT_NEAR(statistics.mean.error_translation / statistics.mean.sigma_translation, 1, 0.03);
    EXPECT_NEAR(statistics.mean.error_rotation / statistics.mean.sigma_rotation, 1, 0.03);
    EXPECT_NEAR(neesStatistics(half).mean.nees, 4 * statistics.mean.nees, 1e-6) << "sigmas are half";
    EXPECT_NEAR(neesStatistics(half).mean.nees_rotation, 4 * statistics.mean.nees_rotation, 1e-6);
    EXPECT_LT(neesStatistics(half).inside, 0.6);
    EXPECT_GT(neesStatistics(wrong).mean.nees, 2) << "of the right size, but another one";
}

// Both ends err on their own, and the first one's orientation has a lever of metres.
TEST_F(Nees, NoiseOfTheTruthIsAllowedFor) {
    const TruthNoise noise{2e-3, 4e-3};
    const auto measured = [&](const Pose& pose) {
        Vector6d error = normal();
        error.head<3>() *= noise.position;
        error.tail<3>() *= noise.orientation;
        return moved(pose, error);
    };
    std::vector<JudgedMotion> allowed, not_allowed;
    for (int i = 0; i < kSamples; ++i) {
        const Pose from = randomPose(random_, 3, 1), to = randomPose(random_, 3, 1);
        const Matrix6d covariance = someCovariance();
        const Pose estimate = moved(from.inverse() * to, covariance.llt().matrixL() * normal());
        const Pose truth = measured(from).inverse() * measured(to);
        allowed.push_back(judgeMotion(truth, estimate, covariance, noise).value());
        not_allowed.push_back(judgeMotion(truth, estimate, covariance).value());
    }
    const NeesStatistics statistics = neesStatistics(allowed);
    EXPECT_NEAR(statistics.mean.nees, 1, 0.03);
    EXPECT_NEAR(statistics.mean.nees_translation, 1, 0.04);
    EXPECT_NEAR(statistics.mean.nees_rotation, 1, 0.04);
    EXPECT_NEAR(statistics.inside, 0.95, 0.01);
    EXPECT_GT(neesStatistics(not_allowed).mean.nees, 3);
}

TEST_F(Nees, OfAKnownError) {
    const Pose truth = randomPose(random_, 2, 1);
    const Vector6d error = (Vector6d() << 0.02, 0, 0, 0, 0, 0.03).finished();
    const Matrix6d covariance = 1e-4 * Matrix6d::Identity();
    const auto motion = judgeMotion(truth, moved(truth, error), covariance);
    ASSERT_TRUE(motion);
    EXPECT_NEAR(motion->nees_translation, 4. / 3, 1e-9);
    EXPECT_NEAR(motion->nees_rotation, 9. / 3, 1e-9);
    EXPECT_NEAR(motion->nees, 13. / 6, 1e-9);
    EXPECT_NEAR(motion->error_translation, 0.02, 1e-12);
    EXPECT_NEAR(motion->error_rotation, 0.03, 1e-12);
    EXPECT_NEAR(motion->sigma_rotation, 0.01 * std::sqrt(3), 1e-12);
    EXPECT_EQ(neesStatistics({*motion, {}}).inside, 0.5);
    EXPECT_NEAR(neesStatistics({*motion, {}}).mean.nees, 13. / 12, 1e-9);
    EXPECT_EQ(neesStatistics({}).count, 0u);
}

TEST_F(Nees, NoneWithoutACovariance) {
    const Pose pose = randomPose(random_, 2, 1);
    for (const double bad : {std::numeric_limits<double>::infinity(), std::nan(""), 0., -1.}) {
        EXPECT_FALSE(judgeMotion(pose, pose, Matrix6d::Constant(bad))) << bad;
        EXPECT_FALSE(judgeMotion(pose, pose, bad * Matrix6d::Identity())) << bad;
    }
    EXPECT_TRUE(judgeMotion(pose, pose, Matrix6d::Zero(), {1e-3, 1e-3})) << "all the noise is the truth's";
}

std::vector<StampedPose> straight(double begin, double end, double rate, double speed = 1) {
    std::vector<StampedPose> poses;
    for (int i = 0; begin + i / rate <= end + 1e-9; ++i)
        poses.push_back({begin + i / rate, Pose(Eigen::Translation3d(speed * (i / rate), 0, 0))});
    return poses;
}

TEST(PoseAt, IsBetweenTheNeighbours) {
    std::vector<StampedPose> trajectory{{10, Pose::Identity()}, {10.05, Pose::Identity()}, {11, Pose()}};
    trajectory[1].T_world_camera =
        Pose(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
    const Pose expected(Eigen::Translation3d(0.4, 0.8, 1.2) *
                        Eigen::AngleAxisd(0.16, Eigen::Vector3d::UnitY()));
    EXPECT_TRUE(poseAt(trajectory, 10.02).value().isApprox(expected, 1e-9));
    EXPECT_TRUE(poseAt(trajectory, 10).value().isApprox(Pose::Identity()));
    EXPECT_TRUE(poseAt(trajectory, 10.05).value().isApprox(trajectory[1].T_world_camera));
    EXPECT_TRUE(poseAt(trajectory, 9.999)) << "as late as a clock may be";
    EXPECT_TRUE(poseAt(trajectory, 11.001));
    EXPECT_TRUE(poseAt(trajectory, 10.999)) << "beside a gap";
    for (const double time : {9.99, 10.5, 11.01}) EXPECT_FALSE(poseAt(trajectory, time)) << time;
    EXPECT_FALSE(poseAt({}, 1));
}

TEST(MotionJudge, TakesTheMotionsOverEachInterval) {
    // The truth begins with the third pose
    const std::vector<StampedPose> estimate = straight(10, 13, 30, 1.01), truth = straight(10.06, 20, 100);
    const double sigma = 0.01;
    MotionJudge judge(truth, {}, {1, 0, 5});
    std::vector<std::pair<std::size_t, std::size_t>> asked;
    for (const StampedPose& pose : estimate)
        judge.add(pose.timestamp, [&](std::size_t from, std::size_t to) {
            asked.emplace_back(from, to);
            return std::pair<Pose, Matrix6d>(
                estimate[from].T_world_camera.inverse() * estimate[to].T_world_camera,
                sigma * sigma * Matrix6d::Identity());
        });
    // Within a tenth of a second: from 0.9 s on
    ASSERT_EQ(judge.motions(0).size(), estimate.size() - 2 - 27);
    ASSERT_EQ(judge.motions(1).size(), estimate.size() - 3);
    EXPECT_EQ(judge.motions(2).size(), 0u) << "shorter than that";
    EXPECT_NEAR(judge.motions(0).back().error_translation, 0.01, 1e-9) << "1 % of a metre";
    EXPECT_NEAR(judge.motions(0).back().nees, std::pow(0.01 / sigma, 2) / 6, 1e-6);
    EXPECT_NEAR(judge.motions(1).back().error_translation, 0.01 * 88 / 30, 1e-9);
    ASSERT_GE(asked.size(), 2u);
    EXPECT_EQ(asked[asked.size() - 2], (std::pair<std::size_t, std::size_t>{60, 90}));
    EXPECT_EQ(asked.back(), (std::pair<std::size_t, std::size_t>{2, 90})) << "the first that has a truth";
}

TEST(MotionJudge, CountsWhatIsNotKnown) {
    MotionJudge judge(straight(10, 11, 30), {}, {0});
    for (const StampedPose& pose : straight(10, 11, 30))
        judge.add(pose.timestamp, [](std::size_t, std::size_t to) -> std::pair<Pose, Matrix6d> {
            if (to > 20) return {Pose(), Matrix6d::Constant(std::numeric_limits<double>::infinity())};
            return {Pose(), Matrix6d::Identity()};
        });
    EXPECT_EQ(judge.motions(0).size(), 20u);
    EXPECT_EQ(judge.unknown(0), 10u);
}

}  // namespace
}  // namespace roevo
