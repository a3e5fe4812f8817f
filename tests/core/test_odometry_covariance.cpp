// Covariances: symmetric, positive, growing away from where the pose is known, and of the right size.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/support/simulated.h"

namespace roevo {
namespace {

using testing::Sequence;
using testing::track;
using testing::TrackedRun;

const Sequence& noisyRoom() {
    static const Sequence sequence = [] {
        auto options = testing::smallRoom();
        options.useKinectNoise();
        return testing::simulate(options, 60);
    }();
    return sequence;
}

TEST(OdometryCovariance, IsSymmetricAndPositive) {
    for (const Mode mode : {Mode::kTracking, Mode::kCoarse}) {
        OdometryOptions options;
        options.mode = mode;
        const TrackedRun run = track(noisyRoom(), options);
        EXPECT_EQ(run.results.front().covariance.norm(), 0) << "the first pose is the frame of reference";
        for (std::size_t i = 1; i < run.results.size(); ++i) {
            const Matrix6d& covariance = run.results[i].covariance;
            EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
            EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues().minCoeff(), 0) << i;
            EXPECT_GT(run.results[i].sigmaTranslation(), 1e-6);
            EXPECT_LT(run.results[i].sigmaTranslation(), 0.1);
            EXPECT_LT(run.results[i].sigmaRotationDeg(), 5);
        }
    }
}

TEST(OdometryCovariance, GrowsFromKeyframeToKeyframe) {
    const TrackedRun run = track(noisyRoom());
    double last = 0;
    int keyframes = 0;
    for (const auto& result : run.results) {
        if (!result.new_keyframe) continue;
        ++keyframes;
        EXPECT_GE(result.sigmaRotationDeg(), last);
        last = result.sigmaRotationDeg();
    }
    ASSERT_GE(keyframes, 2);
}

// Normalised estimation error squared: 1 per degree of freedom if the covariance is right. The odometry's
// errors are correlated in time, so only the order of magnitude is asked for.
TEST(OdometryCovariance, ErrorsAreOfTheSizeThatItSays) {
    const TrackedRun run = track(noisyRoom());
    double sum = 0;
    int n = 0;
    for (std::size_t i = 1; i < run.results.size(); ++i) {
        const Pose &estimate = run.results[i].T_world_camera, &truth = noisyRoom().truth[i].T_world_camera;
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(estimate.linear() * truth.linear().transpose()));
        Vector6d error;
        error << estimate.translation() - truth.translation(), turn.angle() * turn.axis();
        sum += error.dot(run.results[i].covariance.inverse() * error) / 6;
        ++n;
    }
    RecordProperty("nees", std::to_string(sum / n));
    EXPECT_GT(sum / n, 0.1);
    EXPECT_LT(sum / n, 10);
}

TEST(OdometryCovariance, IsTurnedWithTheWorld) {
    Pose start = Pose::Identity();
    start.setRotation(Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix());
    Odometry a(noisyRoom().camera, OdometryOptions()), b(noisyRoom().camera, OdometryOptions(), start);
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = start.linear();
    for (std::size_t i = 0; i < 6; ++i) {
        const Matrix6d first = a.processFrame(noisyRoom().frames[i]).covariance;
        const Matrix6d second = b.processFrame(noisyRoom().frames[i]).covariance;
        EXPECT_LT((turn * first * turn.transpose() - second).norm(), 0.02 * second.norm() + 1e-12);
    }
}

}  // namespace
}  // namespace roevo
