// What is expected of the next frame: constant velocity, how sure that is, and the motion of its rows.
#include <gtest/gtest.h>

#include "roevo/tracking/motion_model.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

constexpr int kHeight = 480;

MotionModel makeModel() {
    return {MotionOptions(), SensorOptions(), kHeight};
}

Pose poseOf(const Eigen::Vector3d& translation, double angle, const Eigen::Vector3d& axis) {
    Pose pose = Pose::Identity();
    pose.setRotation(Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix());
    pose.translation() = translation;
    return pose;
}

const Pose kStart = poseOf({1, -2, 0.5}, 0.7, {1, 2, -1});
const Pose kStep = poseOf({0.02, -0.01, 0.03}, 0.03, {0.2, 1, 0.4});

double difference(const Pose& a, const Pose& b) {
    return (a.matrix() - b.matrix()).norm();
}

/// Anchored at 10 s, and measured once, kStep on, `dt` later.
MotionModel moving(double dt = 0.1) {
    MotionModel model = makeModel();
    model.anchor(10, kStart);
    model.measure(10 + dt, kStart * kStep);
    return model;
}

TEST(MotionModel, PredictsConstantVelocityInTheCamerasOwnFrame) {
    const MotionModel model = moving();
    EXPECT_LT(difference(model.predict(10.1), kStart * kStep), 1e-12);
    EXPECT_LT(difference(model.predict(10.2), kStart * kStep * kStep), 1e-9);
    const Pose half = model.predict(10.15);
    EXPECT_NEAR((half.translation() - (kStart * kStep).translation()).norm(), kStep.translation().norm() / 2,
                1e-9);
    EXPECT_NEAR(rotationAngle((kStart * kStep).inverse() * half), 0.015, 1e-9);
}

TEST(MotionModel, NobodyMovesOnEvenlyForLong) {
    const MotionModel model = moving();
    EXPECT_GT(difference(model.predict(10.6), model.predict(10.5)), 1e-3);
    EXPECT_EQ(difference(model.predict(10.61), model.predict(60)), 0);
}

TEST(MotionModel, ThePriorIsAboutThePredictionSeenFromTheKeyframe) {
    const MotionModel model = moving();
    const Pose T_world_keyframe = poseOf({0.3, 0.1, 0}, 0.2, {0, 0, 1});
    EXPECT_LT(difference(model.prior(10.13, T_world_keyframe).mean,
                         model.predict(10.13).inverse() * T_world_keyframe),
              1e-12);
}

TEST(MotionModel, ThePriorWidensWithTheSquareOfTheTimeSinceTheLastMeasuredPose) {
    const MotionModel model = moving();
    const MotionOptions options;
    for (const double dt : {0.033, 0.1, 0.3, 0.9}) {
        const PosePrior prior = model.prior(10.1 + dt, kStart);
        EXPECT_NEAR(prior.sigma_translation, options.acceleration * dt * dt / 2, 1e-9) << dt;
        EXPECT_NEAR(prior.sigma_rotation, options.angular_acceleration_deg * kDegree * dt * dt / 2, 1e-9)
            << dt;
    }
    const PosePrior soon = model.prior(10.1 + 0.002, kStart);
    EXPECT_DOUBLE_EQ(soon.sigma_translation, 1e-3);
    EXPECT_DOUBLE_EQ(soon.sigma_rotation, 1e-3);
}

TEST(MotionModel, AnAnchorHasNoVelocityAndAPriorAsWideAsTheLikelySpeed) {
    MotionModel model = moving();
    model.anchor(11, kStart);
    EXPECT_EQ(difference(model.predict(11.2), kStart), 0);
    const MotionOptions options;
    const double dt = 0.2;
    const PosePrior prior = model.prior(11 + dt, kStart);
    EXPECT_NEAR(prior.sigma_translation, options.speed * dt + options.acceleration * dt * dt / 2, 1e-9);
    EXPECT_NEAR(prior.sigma_rotation,
                (options.angular_speed_deg * dt + options.angular_acceleration_deg * dt * dt / 2) * kDegree,
                1e-9);
}

TEST(MotionModel, AForgottenVelocityHoldsThePose) {
    MotionModel model = moving();
    const double with_velocity = model.prior(10.2, kStart).sigma_translation;
    model.forgetVelocity();
    EXPECT_LT(difference(model.predict(10.4), kStart * kStep), 1e-12);
    EXPECT_GT(model.prior(10.2, kStart).sigma_translation, with_velocity);
}

TEST(MotionModel, PredictedPosesNeverEnter) {
    MotionModel model = moving();
    const MotionModel untouched = model;
    for (int i = 1; i <= 8; ++i) {
        const double t = 10.1 + i / 30.0;
        model.predict(t);
        model.prior(t, kStart);
        model.shutter(t, kStart);
    }
    EXPECT_EQ(difference(model.predict(10.4), untouched.predict(10.4)), 0);
    EXPECT_EQ(model.prior(10.4, kStart).sigma_translation, untouched.prior(10.4, kStart).sigma_translation);
    // Found again where it was last measured, 0.3 s ago: it stood still, whatever was predicted meanwhile
    model.measure(10.4, kStart * kStep);
    EXPECT_LT(difference(model.predict(10.5), kStart * kStep), 1e-12);
    // and a move over a gap is divided by the whole gap
    model.measure(10.8, kStart * kStep * kStep);
    const Pose next = model.predict(10.9);
    EXPECT_NEAR((next.translation() - (kStart * kStep * kStep).translation()).norm(),
                kStep.translation().norm() / 4, 1e-9);
}

TEST(MotionModel, RowsHaveAMotionOnlyAfterAnOrdinaryInterval) {
    EXPECT_EQ(makeModel().shutter(0.03, kStart).since_previous, 0) << "nothing known yet";
    const MotionModel model = moving();
    for (const double gap : {-0.01, 0.0, 0.001, 0.0045, 0.155, 0.5, 20.0}) {
        const RollingShutter shutter = model.shutter(10.1 + gap, kStart);
        EXPECT_EQ(shutter.since_previous, 0) << gap;
        const RowMotion rows = shutter.motion((kStart * kStep * kStep).inverse() * kStart);
        EXPECT_EQ(rows.velocity.norm() + rows.turn.norm(), 0) << gap;
    }
    for (const double gap : {0.0055, 0.033, 0.145})
        EXPECT_NEAR(model.shutter(10.1 + gap, kStart).since_previous, gap, 1e-9);
}

TEST(MotionModel, AnEarlierIntervalOfUnusualLengthIsNotUsed) {
    for (const double dt : {0.004, 0.3}) {
        const RollingShutter shutter = moving(dt).shutter(10 + dt + 0.03, kStart);
        EXPECT_GT(shutter.since_previous, 0) << dt;
        EXPECT_EQ(shutter.earlier_interval, 0) << dt;
    }
    EXPECT_NEAR(moving(0.05).shutter(10.08, kStart).earlier_interval, 0.05, 1e-9);
}

TEST(MotionModel, RowMotionIsExactAtTheFramesTimeUnderConstantAcceleration) {
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
        const RowMotion rows = model.shutter(t2, kStart).motion(truth(t2).inverse() * kStart);
        const Eigen::Vector3d velocity = truth(t2).linear().transpose() * (v0 + a * t2),
                              turn = (w0 + w1 * t2) * axis;
        EXPECT_LT((rows.velocity - velocity).norm(), 1e-9) << first << " " << second;
        EXPECT_LT((rows.turn - turn).norm(), 1e-9) << first << " " << second;
        // The mean over the last interval alone would be off by half of what the acceleration adds
        const Eigen::Vector3d mean = (truth(t2).translation() - truth(t1).translation()) / second;
        EXPECT_GT((truth(t2).linear().transpose() * mean - velocity).norm(), 0.4 * a.norm() * second);
    }
}

}  // namespace
}  // namespace roevo
