// How the rows of a frame move, by the poses before it, and how sure that is.
#include <gtest/gtest.h>

#include "core/support/motions.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::kStart;
using testing::kStep;
using testing::makeModel;
using testing::moving;
using testing::poseOf;

// The first keyframe of a track has no frame before it: how its rows moved shows only in the next one.
TEST(MotionModel, TheRowsOfAFirstKeyframeMoveAsTheCameraWentOn) {
    const MotionModel model = makeModel();
    const RowMotion rows = model.firstRows(0.1, kStep);
    EXPECT_LT((rows.velocity - kStep.translation() / 0.1).norm(), 1e-12);
    EXPECT_NEAR(rows.turn.norm(), 0.3, 1e-9);
    EXPECT_EQ(rows.reference_row, model.stillRows().reference_row);
    for (const double interval : {0.0, -0.1, 5.0})
        EXPECT_FALSE(model.firstRows(interval, kStep).known()) << interval;
}

TEST(MotionModel, RowsHaveAMotionOnlyAfterAnOrdinaryInterval) {
    EXPECT_EQ(makeModel().predict(0.03).shutter.since_previous, 0) << "nothing known yet";
    const MotionModel model = moving();
    for (const double gap : {-0.01, 0.0, 0.001, 0.0045, 0.355, 0.5, 20.0}) {
        const RollingShutter shutter = model.predict(10.1 + gap).shutter;
        EXPECT_EQ(shutter.since_previous, 0) << gap;
        const RowMotion rows = shutter.motion((kStart * kStep * kStep).inverse());
        EXPECT_EQ(rows.velocity.norm() + rows.turn.norm(), 0) << gap;
    }
    for (const double gap : {0.0055, 0.033, 0.145, 0.345})
        EXPECT_NEAR(model.predict(10.1 + gap).shutter.since_previous, gap, 1e-9);
}

TEST(MotionModel, AnEarlierIntervalOfUnusualLengthIsNotUsed) {
    for (const double dt : {0.004, 0.4}) {
        const RollingShutter shutter = moving(dt).predict(10 + dt + 0.03).shutter;
        EXPECT_GT(shutter.since_previous, 0) << dt;
        EXPECT_EQ(shutter.earlier_interval, 0) << dt;
    }
    EXPECT_NEAR(moving(0.05).predict(10.08).shutter.earlier_interval, 0.05, 1e-9);
}

TEST(MotionModel, RowMotionIsHalfWayFromTheMeanToTheFramesTimeUnderConstantAcceleration) {
    const Eigen::Vector3d v0(0.3, -0.2, 0.5), a(1.5, 2, -1),
        axis = Eigen::Vector3d(0.3, 1, -0.5).normalized();
    const double w0 = 0.8, w1 = -2.5;
    const auto truth = [&](double t) {
        return poseOf(v0 * t + a * t * t / 2, w0 * t + w1 * t * t / 2, axis);
    };
    for (const auto& [first, second] :
         {std::pair(0.033, 0.033), std::pair(0.02, 0.1), std::pair(0.1, 0.03)}) {
        MotionModel model = makeModel();
        const double t1 = first, t2 = first + second;
        model.anchor(0, truth(0));
        model.measure(t1, truth(t1));
        const RowMotion rows = model.predict(t2).shutter.motion(truth(t2).inverse());
        const Eigen::Vector3d velocity = truth(t2).linear().transpose() * (v0 + a * t2),
                              turn = (w0 + w1 * t2) * axis;
        const Eigen::Vector3d mean = truth(t2).linear().transpose() *
                                     (truth(t2).translation() - truth(t1).translation()) / second,
                              mean_turn = (w0 + w1 * (t1 + t2) / 2) * axis;
        EXPECT_LT((rows.velocity - (velocity + mean) / 2).norm(), 1e-9) << first << " " << second;
        EXPECT_LT((rows.turn - (turn + mean_turn) / 2).norm(), 1e-9) << first << " " << second;
        EXPECT_GT((mean - velocity).norm(), 0.4 * a.norm() * second) << "else there is nothing to see";
    }
}

TEST(MotionModel, TheRowsVelocityIsAsUncertainAsHalfAnIntervalsAccelerationOrAsAnySpeedIsLikely) {
    const MotionOptions likely;
    const auto sigma = [](const RollingShutter& shutter) {
        return shutter.velocity_variance.cwiseSqrt().eval();
    };
    for (const double dt : {0.033, 0.1}) {
        const Vector6d guessed = sigma(moving().predict(10.1 + dt).shutter);
        EXPECT_NEAR(guessed[1], likely.acceleration * dt / 2, 1e-9) << dt;
        EXPECT_NEAR(guessed[4], likely.angular_acceleration_deg * kDegree * dt / 2, 1e-9) << dt;
    }
    for (const Vector6d& unknown :
         {sigma(makeModel().predict(0.03).shutter), sigma(moving().predict(11).shutter)}) {
        EXPECT_NEAR(unknown[2], likely.speed, 1e-9);
        EXPECT_NEAR(unknown[3], likely.angular_speed_deg * kDegree, 1e-9);
    }
}

TEST(MotionModel, AVelocityFollowsPosesAsFarAsTheyCanBeTrusted) {
    constexpr double kDt = 1. / 30;
    PoseUncertainty uncertainty;
    uncertainty.independent.diagonal() << 1e-8, 1e-8, 1e-8, 1e-2, 1e-8, 1e-8;  // not about x
    MotionModel model = makeModel();
    model.anchor(0, Pose::Identity());
    model.measure(kDt, Pose::Identity(), uncertainty);
    const auto turnOf = [&](const Eigen::Vector3d& axis) {
        return model.predict(2 * kDt).shutter.motion(poseOf({0, 0, 0}, 0.01, axis).inverse()).turn.norm();
    };
    const double all = 1.25 * 0.01 / kDt;
    EXPECT_NEAR(turnOf({0, 1, 0}), all, 0.02 * all);
    EXPECT_LT(turnOf({1, 0, 0}), 0.05 * all);
}

}  // namespace
}  // namespace roevo
