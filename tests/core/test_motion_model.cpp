// What is expected of the next frame: constant velocity, and how sure that is.
#include <gtest/gtest.h>

#include "core/support/motions.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::difference;
using testing::kStart;
using testing::kStep;
using testing::makeModel;
using testing::moving;
using testing::poseOf;

double sigmaOfPosition(const PosePrior& prior) {
    return std::sqrt(prior.covariance.topLeftCorner<3, 3>().trace() / 3);
}

double sigmaOfOrientation(const PosePrior& prior) {
    return std::sqrt(prior.covariance.bottomRightCorner<3, 3>().trace() / 3);
}

TEST(MotionModel, PredictsConstantVelocityInTheCamerasOwnFrame) {
    const MotionModel model = moving();
    EXPECT_LT(difference(model.predict(10.1).T_reference_camera, kStart * kStep), 1e-12);
    EXPECT_LT(difference(model.predict(10.2).T_reference_camera, kStart * kStep * kStep), 1e-9);
    const Pose half = model.predict(10.15).T_reference_camera;
    EXPECT_NEAR((half.translation() - (kStart * kStep).translation()).norm(), kStep.translation().norm() / 2,
                1e-9);
    EXPECT_NEAR(rotationAngle((kStart * kStep).inverse() * half), 0.015, 1e-9);
}

TEST(MotionModel, TheFirstIntervalMayBeAGap) {
    MotionModel model = makeModel();
    model.expect(10);
    model.anchor(10, Pose());
    model.expect(20);
    EXPECT_TRUE(model.predict(20).blind);
    model = makeModel();
    model.expect(10);
    model.anchor(10, Pose());
    model.expect(11);
    EXPECT_FALSE(model.predict(11).blind) << "a frame a second";
}

TEST(MotionModel, NobodyMovesOnEvenlyForLong) {
    const MotionModel model = moving();
    EXPECT_GT(difference(model.predict(10.6).T_reference_camera, model.predict(10.5).T_reference_camera),
              1e-3);
    EXPECT_EQ(difference(model.predict(10.61).T_reference_camera, model.predict(60).T_reference_camera), 0);
}

TEST(MotionModel, AnotherReferenceChangesNothingButTheNumbers) {
    MotionModel model = moving();
    const Prediction before = model.predict(10.13);
    const Pose T_new_old = poseOf({0.3, 0.1, 0}, 0.2, {0, 0, 1});
    model.changeReference(T_new_old);
    const Prediction after = model.predict(10.13);
    EXPECT_LT(difference(after.T_reference_camera, T_new_old * before.T_reference_camera), 1e-12);
    EXPECT_LT(difference(after.T_reference_last, T_new_old * before.T_reference_last), 1e-12);
    EXPECT_LT(difference(after.prior.mean, after.T_reference_camera.inverse()), 1e-12);
    EXPECT_EQ(after.prior.covariance, before.prior.covariance);
    EXPECT_LT((after.shutter.rows.velocity - before.shutter.rows.velocity).norm(), 1e-12);
}

// A mean velocity is that of the middle of its interval. The prior that took it for the velocity at the end
// was half as wide as its own acceleration allows.
TEST(MotionModel, UnderConstantAccelerationThePredictionErrsByWhatThePriorSays) {
    const MotionOptions options;
    const auto truth = [&](double t) {
        return poseOf({0, 0, options.acceleration * t * t / 2}, 0, {0, 0, 1});
    };
    for (const auto& [interval, dt] : {std::pair(0.1, 0.1), std::pair(0.033, 0.1), std::pair(0.1, 0.3)}) {
        MotionModel model = makeModel();
        model.anchor(0, truth(0));
        model.measure(interval, truth(interval));
        const Prediction prediction = model.predict(interval + dt);
        const double error =
            (prediction.T_reference_camera.translation() - truth(interval + dt).translation()).norm();
        EXPECT_NEAR(error, options.acceleration * dt * (dt + interval) / 2, 1e-9);
        EXPECT_NEAR(sigmaOfPosition(prediction.prior), error, 1e-9);
    }
}

TEST(MotionModel, UnderConstantAngularAccelerationThePredictionErrsByWhatThePriorSays) {
    const double acceleration = MotionOptions().angular_acceleration_deg * kDegree;
    const auto truth = [&](double t) { return poseOf({0, 0, 0}, acceleration * t * t / 2, {1, -2, 0.5}); };
    for (const auto& [interval, dt] : {std::pair(0.1, 0.1), std::pair(0.033, 0.1), std::pair(0.1, 0.3)}) {
        MotionModel model = makeModel();
        model.anchor(0, truth(0));
        model.measure(interval, truth(interval));
        const Prediction prediction = model.predict(interval + dt);
        const double error = rotationAngle(prediction.T_reference_camera.inverse() * truth(interval + dt));
        EXPECT_NEAR(error, acceleration * dt * (dt + interval) / 2, 1e-7);
        EXPECT_NEAR(sigmaOfOrientation(prediction.prior), error, 1e-7);
    }
}

TEST(MotionModel, NoPriorIsNarrowerThanAMillimetreAndAMilliradian) {
    const PosePrior soon = moving().predict(10.1 + 0.0005).prior;
    EXPECT_DOUBLE_EQ(sigmaOfPosition(soon), 1e-3);
    EXPECT_DOUBLE_EQ(sigmaOfOrientation(soon), 1e-3);
}

TEST(MotionModel, ErrorsOfTheMeasuredPosesWidenThePrior) {
    const MotionOptions options;
    constexpr double kStep_s = 0.03, kSigma = 0.01;
    const PoseUncertainty uncertainty{kSigma * kSigma * Matrix6d::Identity(), {}};
    MotionModel model = makeModel();
    model.anchor(0, Pose());
    model.measure(kStep_s, Pose(), uncertainty);
    model.measure(2 * kStep_s, Pose(), uncertainty);
    const double by_motion = options.acceleration * kStep_s * kStep_s;
    // The last pose enters twice: as the start, and in the velocity
    EXPECT_NEAR(sigmaOfPosition(model.predict(3 * kStep_s).prior),
                std::sqrt(by_motion * by_motion + 5 * kSigma * kSigma), 1e-9);
}

// A camera that sees only upright edges does not know how high it is. The other directions need not suffer.
TEST(MotionModel, TheDirectionThatIsNotKnownIsTheOneThatThePriorIsWideIn) {
    constexpr double kDt = 1. / 30, kSigma = 0.05;
    PoseUncertainty uncertainty;
    uncertainty.independent.diagonal() << 1e-6, kSigma * kSigma, 1e-6, 1e-6, 1e-6, 1e-6;
    const auto predicted = [&](const PoseUncertainty& measured) {
        MotionModel model = makeModel();
        model.anchor(0, Pose());
        model.measure(kDt, Pose(), measured);
        model.measure(2 * kDt, Pose(), measured);
        return model.predict(3 * kDt).prior.covariance;
    };
    const Matrix6d exact = predicted({}), unsure = predicted(uncertainty);
    EXPECT_NEAR(unsure(1, 1), exact(1, 1) + 5 * kSigma * kSigma, 1e-9);
    for (const int k : {0, 2, 3, 4, 5}) EXPECT_NEAR(unsure(k, k), exact(k, k) + 5e-6, 1e-9) << k;
}

TEST(MotionModel, WhatIsNotKnownTurnsWithTheCamera) {
    constexpr double kDt = 1. / 30, kSigma = 0.05;
    const Pose quarter = poseOf({0, 0, 0}, kPi / 2, {0, 0, 1});
    PoseUncertainty along_x;
    along_x.independent(0, 0) = kSigma * kSigma;
    MotionModel model = makeModel();
    model.anchor(0, Pose());
    model.measure(kDt, quarter, along_x);
    const PosePrior prior = model.predict(2 * kDt).prior;  // turned by as much again
    for (const Matrix6d& covariance : {prior.covariance, prior.errors.covariance()}) {
        EXPECT_GT(covariance(1, 1), kSigma * kSigma) << "what was along x is along y now";
        EXPECT_LT(covariance(0, 0), 0.1 * kSigma * kSigma);
    }
}

TEST(MotionModel, WhatWasNotKnownStaysUnknownUntilThePoseIsTheReference) {
    constexpr double kDt = 1. / 30;
    PoseUncertainty uncertainty;
    uncertainty.influences = {{7, Vector6d::Unit(1)}};
    MotionModel model = makeModel();
    model.anchor(0, kStart);
    model.measure(kDt, kStart * kStep, uncertainty);
    const PoseUncertainty carried = model.predict(2 * kDt).prior.errors;
    ASSERT_EQ(carried.influences.size(), 1U) << "what the edge does is not forgotten";
    EXPECT_EQ(carried.influences[0].cluster, 7);
    EXPECT_NEAR(carried.influences[0].moved.norm(), 1, 1e-9);
    const MotionOptions likely;
    EXPECT_NEAR(std::sqrt(carried.independent(0, 0)), likely.acceleration * kDt * kDt, 1e-9);
    model.becomeReference();
    const PoseUncertainty fresh = model.predict(2 * kDt).prior.errors;
    EXPECT_TRUE(fresh.influences.empty());
    EXPECT_LT((fresh.independent - carried.independent).norm(), 1e-12) << "the motion is as it was";
}

// The velocity between two stamps that nearly coincide was that of their errors, divided by nearly nothing.
TEST(MotionModel, TwoStampsThatNearlyCoincideMakeNoVelocity) {
    MotionModel model = moving();
    const Pose off = poseOf({0.001, 0, 0}, 0, {0, 0, 1});
    model.measure(10.1 + 1e-6, kStart * kStep * off);
    const Prediction next = model.predict(10.2);
    EXPECT_TRUE(next.T_reference_camera.isFinite());
    EXPECT_LT((next.T_reference_camera.translation() - (kStart * kStep * kStep).translation()).norm(), 0.005);
}

// Frames that arrive together were not taken together.
TEST(MotionModel, TwoStampsThatNearlyCoincideSayNothingOfHowFarTheCameraMoved) {
    MotionModel model = makeModel();
    for (int i = 0; i < 4; ++i) {
        model.expect(10 + i / 30.);
        model.measure(10 + i / 30., Pose());
    }
    const double arrival = 10.1 + 0.002;
    model.expect(arrival);
    EXPECT_NEAR(sigmaOfPosition(model.predict(arrival).prior),
                sigmaOfPosition(model.predict(10.1 + 1 / 30.).prior), 1e-3);
}

TEST(MotionModel, TwoStampsThatNearlyCoincideAfterAnAnchorMakeNoneEither) {
    MotionModel model = makeModel();
    model.anchor(10, kStart);
    model.measure(10 + 1e-6, kStart * poseOf({0.001, 0, 0}, 0.001, {0, 0, 1}));
    EXPECT_LT((model.predict(10.1).T_reference_camera.translation() - kStart.translation()).norm(), 0.0011);
    EXPECT_TRUE(model.predict(10.1).prior.covariance.allFinite());
    EXPECT_EQ(model.predict(10.1).shutter.earlier_interval, 0);
}

TEST(MotionModel, AnAnchorHasNoVelocityAndAPriorAsWideAsTheLikelySpeed) {
    MotionModel model = moving();
    model.anchor(11, kStart);
    EXPECT_EQ(difference(model.predict(11.2).T_reference_camera, kStart), 0);
    const MotionOptions options;
    const double dt = 0.2;
    const PosePrior prior = model.predict(11 + dt).prior;
    EXPECT_NEAR(sigmaOfPosition(prior), options.speed * dt + options.acceleration * dt * dt / 2, 1e-9);
    EXPECT_NEAR(sigmaOfOrientation(prior),
                (options.angular_speed_deg * dt + options.angular_acceleration_deg * dt * dt / 2) * kDegree,
                1e-9);
}

TEST(MotionModel, AForgottenVelocityHoldsThePose) {
    MotionModel model = moving();
    const double with_velocity = sigmaOfPosition(model.predict(10.2).prior);
    model.forgetVelocity();
    EXPECT_LT(difference(model.predict(10.4).T_reference_camera, kStart * kStep), 1e-12);
    EXPECT_GT(sigmaOfPosition(model.predict(10.2).prior), with_velocity);
}

TEST(MotionModel, PredictedPosesNeverEnter) {
    MotionModel model = moving();
    const MotionModel untouched = model;
    for (int i = 1; i <= 8; ++i) {
        const double t = 10.1 + i / 30.0;
        (void)model.predict(t);
    }
    EXPECT_EQ(difference(model.predict(10.4).T_reference_camera, untouched.predict(10.4).T_reference_camera),
              0);
    EXPECT_EQ(model.predict(10.4).prior.covariance, untouched.predict(10.4).prior.covariance);
    // Found again where it was last measured, 0.3 s ago: it stood still, whatever was predicted meanwhile
    model.measure(10.4, kStart * kStep);
    EXPECT_LT(difference(model.predict(10.5).T_reference_camera, kStart * kStep), 1e-12);
    // and a move over a gap is divided by the whole gap
    model.measure(10.7, kStart * kStep * kStep);
    const Pose next = model.predict(10.8).T_reference_camera;
    EXPECT_NEAR((next.translation() - (kStart * kStep * kStep).translation()).norm(),
                kStep.translation().norm() / 3, 1e-9);
}

TEST(MotionModel, OnlyASearchLooksAroundAPoseThatWasNotMeasured) {
    MotionModel model = moving();
    const Prediction before = model.predict(10.2);
    const Pose assumed = kStart * kStep * kStep;
    model.assume(assumed);
    const Prediction after = model.predict(10.2);
    EXPECT_EQ(difference(after.T_reference_last, assumed), 0);
    EXPECT_EQ(difference(model.lastPose(), assumed), 0);
    EXPECT_EQ(difference(after.T_reference_camera, before.T_reference_camera), 0);
    EXPECT_EQ(difference(after.prior.mean, before.prior.mean), 0);
    EXPECT_EQ(after.prior.covariance, before.prior.covariance);
    EXPECT_EQ(difference(after.shutter.T_previous_keyframe, before.shutter.T_previous_keyframe), 0);
    model.measure(10.3, kStart);
    EXPECT_EQ(difference(model.lastPose(), kStart), 0);
}

TEST(MotionModel, TheBrightnessIsKnownUntilTheReferenceChanges) {
    MotionModel model = moving();
    model.setBrightness({1.3, -7});
    EXPECT_EQ(model.predict(10.2).brightness.gain, 1.3);
    EXPECT_EQ(model.predict(10.2).brightness.offset, -7);
    model.changeReference(kStep);
    EXPECT_EQ(model.predict(10.2).brightness.gain, 1);
    EXPECT_EQ(model.predict(10.2).brightness.offset, 0);
}

TEST(MotionModel, AMeanOverALongTimeIsNoVelocity) {
    for (const double interval : {0.3, 0.4}) {
        MotionModel model = makeModel();
        model.anchor(10, Pose());
        model.measure(10 + interval, poseOf({0.1, 0, 0}, 0, {1, 0, 0}));
        const double ahead = model.predict(10.1 + interval).T_reference_camera.translation().x() - 0.1;
        EXPECT_NEAR(ahead, interval < 0.35 ? 0.1 * 0.1 / interval : 0, 1e-9) << interval;
    }
}

/// Frames at these times, each tracked.
bool isBlindAfter(const std::vector<double>& times) {
    MotionModel model = makeModel();
    bool blind = false;
    for (const double time : times) {
        model.expect(time);
        blind = model.predict(time).blind;
        model.measure(time, Pose());
    }
    return blind;
}

TEST(MotionModel, AGapIsWhatIsLongAndLongerThanUsual) {
    EXPECT_FALSE(isBlindAfter({10, 10.03, 10.06, 10.09}));
    EXPECT_FALSE(isBlindAfter({10, 10.03, 10.06, 10.12})) << "one frame was dropped";
    EXPECT_TRUE(isBlindAfter({10, 10.03, 10.06, 10.2})) << "four were";
    EXPECT_TRUE(isBlindAfter({10, 10.03, 10.06, 10.7}));
    EXPECT_FALSE(isBlindAfter({-10, -9.3, -8.6, -7.9})) << "times before zero are times";
    EXPECT_FALSE(isBlindAfter({10, 10.7, 11.4, 12.1})) << "frames are always so far apart";
    EXPECT_TRUE(isBlindAfter({10, 10.7, 11.4, 13.4}));
    std::vector<double> slower{10, 10.03, 10.06, 10.09};
    for (int i = 1; i <= 20; ++i) slower.push_back(10 + i);
    EXPECT_FALSE(isBlindAfter(slower)) << "the rate has changed";
}

TEST(MotionModel, AGapOfAFastCameraIsAsLongAsThatOfAnother) {
    EXPECT_FALSE(isBlindAfter({10, 10.016, 10.032, 10.048, 10.098})) << "two frames of 60 Hz were dropped";
    EXPECT_TRUE(isBlindAfter({10, 10.016, 10.032, 10.048, 10.148}));
}

TEST(MotionModel, FastCamerasHaveAVelocityToo) {
    constexpr double kInterval = 1 / 240.0, kSpeed = 1;  // s, m/s
    MotionModel model = makeModel();
    const auto place = [&](double time) { return poseOf({kSpeed * time, 0, 0}, 0, {0, 0, 1}); };
    for (int i = 0; i < 5; ++i) {
        model.expect(i * kInterval);
        if (i == 0) model.anchor(0, Pose());
        model.measure(i * kInterval, place(i * kInterval));
    }
    const Prediction next = model.predict(5 * kInterval);
    EXPECT_NEAR(next.T_reference_camera.translation().x(), kSpeed * 5 * kInterval, 1e-9);
    EXPECT_GT(next.shutter.since_previous, 0);
}

TEST(MotionModel, TheFirstRowsAreNotThoseOfTwoStampsThatNearlyCoincide) {
    EXPECT_FALSE(makeModel().firstRows(1e-3, poseOf({0.002, 0, 0}, 0, {0, 0, 1})).known());
    EXPECT_TRUE(makeModel().firstRows(0.03, poseOf({0.002, 0, 0}, 0, {0, 0, 1})).known());
}

TEST(MotionModel, HoweverLongItWasNotSeenACameraIsWithinReach) {
    const MotionOptions options;
    for (MotionModel model : {makeModel(), moving()}) {
        model.anchor(10, kStart);
        double before = 0;
        for (const double away : {0.3, 0.6, 2.0, 120.0, 1e5, 1e9}) {
            const PosePrior prior = model.predict(10 + away).prior;
            EXPECT_GE(sigmaOfPosition(prior), before) << away << " s";
            before = sigmaOfPosition(prior);
            EXPECT_LE(before, options.acceleration + options.speed * std::min(away, 3600.0));
            EXPECT_LE(sigmaOfOrientation(prior), 180.001 * kDegree);
        }
    }
}

}  // namespace
}  // namespace roevo
