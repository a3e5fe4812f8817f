// Rows read one after the other: the two directions of the correction agree, and the read-out time is found.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/support/random_pose.h"
#include "roevo/options.h"
#include "tracking/readout_estimator.h"
#include "tracking/rolling_shutter.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kPlainCamera{640, 480, 525, 525, 319.5, 239.5, {}};

Eigen::Vector2d projectOne(const Pose& pose, const RowMotion& rows, const Eigen::Vector3d& point) {
    alignas(32) float x[8] = {}, y[8] = {}, z[8] = {}, ox[8], oy[8], oz[8], u[8], v[8];
    x[0] = static_cast<float>(point.x());
    y[0] = static_cast<float>(point.y());
    z[0] = static_cast<float>(point.z());
    kernels::baseline().project(makeProjection(pose, kPlainCamera, rows), x, y, z, 8, {ox, oy, oz, u, v});
    return {static_cast<double>(u[0]), static_cast<double>(v[0])};
}

RowMotion randomMotion(std::mt19937& random) {
    RowMotion rows;
    for (int k = 0; k < 3; ++k) {
        rows.velocity[k] = uniform(random, -0.5, 0.5);
        rows.turn[k] = uniform(random, -1, 1);
    }
    rows.seconds_per_row = 0.03 / 480;
    rows.reference_row = 239.5;
    return rows;
}

TEST(RowMotion, APointBroughtToTheReferenceRowIsSeenWhereItWasSeen) {
    std::mt19937 random(91);
    double moved = 0, worst = 0;
    for (int i = 0; i < 500; ++i) {
        const RowMotion rows = randomMotion(random);
        const double u = uniform(random, 20, 620), v = uniform(random, 20, 460),
                     depth = uniform(random, 0.8, 5);
        const Eigen::Vector3d at_reference = rows.toReference(kPlainCamera.backProject(u, v, depth), v);
        moved = std::max(moved, (kPlainCamera.project(at_reference) - Eigen::Vector2d(u, v)).norm());
        worst = std::max(worst,
                         (projectOne(Pose::Identity(), rows, at_reference) - Eigen::Vector2d(u, v)).norm());
    }
    EXPECT_GT(moved, 5) << "the correction must do something";
    // First order in time: what is left is of second order, a few hundredths of the correction
    EXPECT_LT(worst, 0.05 * moved);
}

TEST(RowMotion, AtOrdinarySpeedTheRoundTripIsExactToATwentiethOfAPixel) {
    std::mt19937 random(92);
    for (int i = 0; i < 500; ++i) {
        RowMotion rows = randomMotion(random);
        rows.velocity *= 0.3;
        rows.turn *= 0.3;
        const double u = uniform(random, 20, 620), v = uniform(random, 20, 460),
                     depth = uniform(random, 1, 5);
        const Eigen::Vector3d at_reference = rows.toReference(kPlainCamera.backProject(u, v, depth), v);
        EXPECT_LT((projectOne(Pose::Identity(), rows, at_reference) - Eigen::Vector2d(u, v)).norm(), 0.05);
    }
}

TEST(RowMotion, IsWhatAMovingCameraSees) {
    // A camera that turns and moves at a constant rate looks at a fixed point: the row it appears on is the
    // one that is being read while it is there.
    std::mt19937 random(93);
    for (int i = 0; i < 100; ++i) {
        RowMotion rows = randomMotion(random);
        rows.velocity *= 0.3;
        rows.turn *= 0.3;
        const Eigen::Vector3d point =
            kPlainCamera.backProject(uniform(random, 50, 590), uniform(random, 50, 430), 2);
        const auto poseAfter = [&](double seconds) {  // camera pose relative to the reference row's
            Vector6d xi;
            xi << rows.velocity * seconds, rows.turn * seconds;
            return poseIncrement(xi);
        };
        Eigen::Vector2d pixel = kPlainCamera.project(point);
        for (int k = 0; k < 20; ++k) {
            const double seconds = (pixel.y() - rows.reference_row) * rows.seconds_per_row;
            pixel = kPlainCamera.project(poseAfter(seconds).inverse() * point);
        }
        EXPECT_LT((projectOne(Pose::Identity(), rows, point) - pixel).norm(), 0.05);
    }
}

TEST(RowMotion, NoReadoutTimeChangesNothing) {
    std::mt19937 random(94);
    RowMotion rows = randomMotion(random);
    rows.seconds_per_row = 0;
    const Eigen::Vector3d point(0.3, -0.2, 1.7);
    EXPECT_EQ(rows.toReference(point, 17), point);
    EXPECT_LT((projectOne(Pose::Identity(), rows, point) - kPlainCamera.project(point)).norm(), 1e-3);
}

TEST(RowMotion, PyramidLevelsSeeTheSameShift) {
    std::mt19937 random(95);
    const RowMotion rows = randomMotion(random);
    const Eigen::Vector3d point = kPlainCamera.backProject(500, 400, 2);
    const Eigen::Vector2d shift = projectOne(Pose::Identity(), rows, point) - kPlainCamera.project(point);
    for (int level = 1; level < 4; ++level) {
        const PinholeCamera camera = kPlainCamera.atPyramidLevel(level);
        const RowMotion scaled = rows.atPyramidLevel(level);
        EXPECT_NEAR(scaled.seconds_per_row * camera.height, rows.seconds_per_row * kPlainCamera.height, 1e-9);
        alignas(32) float x[8] = {}, y[8] = {}, z[8] = {}, ox[8], oy[8], oz[8], u[8], v[8];
        x[0] = static_cast<float>(point.x());
        y[0] = static_cast<float>(point.y());
        z[0] = static_cast<float>(point.z());
        kernels::baseline().project(makeProjection(Pose::Identity(), camera, scaled), x, y, z, 8,
                                    {ox, oy, oz, u, v});
        const Eigen::Vector2d at(static_cast<double>(u[0]), static_cast<double>(v[0]));
        EXPECT_LT(((at - camera.project(point)) * (1 << level) - shift).norm(), 0.02) << level;
    }
}

Eigen::Vector3d exchanged(const RowMotion& from, const RowMotion& to, const Eigen::Vector3d& point,
                          double row) {
    Points3 points;
    points.add(point);
    exchangeMotion(from, to, {static_cast<float>(row)}, 1, points);
    return points.at(0);
}

TEST(RowMotion, ExchangedForAnotherMotionAPointIsWhereThatWouldHavePutIt) {
    std::mt19937 random(92);
    double furthest = 0;
    for (int i = 0; i < 500; ++i) {
        const RowMotion one = randomMotion(random), other = randomMotion(random).at(-2e-5);
        const Eigen::Vector3d seen(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 1, 4));
        const double row = uniform(random, 0, 479);
        const Eigen::Vector3d by_one = one.toReference(seen, row), by_other = other.toReference(seen, row);
        const double apart = (by_one - by_other).norm();
        furthest = std::max(furthest, apart);
        EXPECT_LT((exchanged(one, other, by_one, row) - by_other).norm(), 0.03 * (apart + 0.01));
        EXPECT_LT((exchanged(one, one, by_one, row) - by_one.cast<float>().cast<double>()).norm(), 1e-12);
    }
    EXPECT_GT(furthest, 0.03) << "else nothing was moved";
}

TEST(RowMotion, ManyPointsAreExchangedAsEachOfThem) {
    std::mt19937 random(93);
    const RowMotion one = randomMotion(random), other = randomMotion(random).at(-2e-5);
    Points3 points;
    std::vector<float> rows;
    for (int i = 0; i < 200; ++i) {
        points.add(Eigen::Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 1, 4)));
        rows.push_back(static_cast<float>(uniform(random, 0, 479)));
    }
    points.add(Eigen::Vector3d(0, 0, 5));  // not to be moved
    Points3 all = points;
    exchangeMotion(one, other, rows, rows.size(), all);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        // To first order: what the one did to the point is undone, and what the other would have done is done
        const auto row = static_cast<double>(rows[i]);
        const Eigen::Vector3d by_one = one.toReference(points.at(i), row) - points.at(i),
                              by_other = other.toReference(points.at(i), row) - points.at(i);
        EXPECT_LT((all.at(i) - (points.at(i) - by_one + by_other)).norm(), 2e-6) << i;
    }
    EXPECT_EQ(all.at(rows.size()), points.at(rows.size()));
}

TEST(RowMotion, IsKnownOnceAnythingMoves) {
    RowMotion rows;
    rows.seconds_per_row = 1e-4;
    rows.reference_row = 100;
    EXPECT_FALSE(rows.known());
    EXPECT_EQ(rows, rows.at(1e-4));
    rows.turn.y() = 1e-9;
    EXPECT_TRUE(rows.known());
}

TEST(RollingShutter, MotionIsTheCamerasVelocityInItsOwnFrame) {
    std::mt19937 random(96);
    for (int i = 0; i < 50; ++i) {
        const Pose T_world_keyframe = testing::randomPose(random, 2, 1);
        const Pose T_world_previous = T_world_keyframe * testing::randomPose(random, 0.1, 0.1);
        const Eigen::Vector3d velocity(0.3, -0.2, 0.5), turn(0.4, 0.2, -0.6);  // in the camera's frame
        const double dt = 0.04;
        Pose T_previous_current = Pose::Identity();
        T_previous_current.setRotation(
            Eigen::AngleAxisd(turn.norm() * dt, turn.normalized()).toRotationMatrix());
        T_previous_current.translation() = T_previous_current.linear() * velocity * dt;
        const Pose T_world_current = T_world_previous * T_previous_current;
        RollingShutter shutter;
        shutter.rows.seconds_per_row = 1e-4;
        shutter.rows.reference_row = 100;
        shutter.T_previous_keyframe = T_world_previous.inverse() * T_world_keyframe;
        shutter.since_previous = dt;
        const RowMotion rows = shutter.motion(T_world_current.inverse() * T_world_keyframe);
        EXPECT_LT((rows.velocity - velocity).norm(), 1e-9);
        EXPECT_LT((rows.turn - turn).norm(), 1e-9);
        EXPECT_EQ(rows.seconds_per_row, 1e-4);
        EXPECT_EQ(rows.reference_row, 100);
        shutter.since_previous = 0;
        const RowMotion still = shutter.motion(T_world_current.inverse() * T_world_keyframe);
        EXPECT_EQ(still.velocity.norm() + still.turn.norm(), 0);
    }
}

// Poses that follow from edges in the rows that are read first: where a frame's pose is off, the next one's
// is off the other way, since the velocity between both brings the edges back to where they are seen.
TEST(RollingShutter, PosesFromTheFirstRowsAloneComeToRest) {
    constexpr double kDt = 1. / 30, kReadout = 0.02;
    double angle = 0.01, before = -0.01;
    for (int frame = 0; frame < 30; ++frame) {
        RollingShutter shutter;
        shutter.rows.seconds_per_row = kReadout / 480;
        shutter.rows.reference_row = 239.5;
        const auto turned = [](double by) {
            Pose pose = Pose::Identity();
            pose.setRotation(Eigen::AngleAxisd(by, Eigen::Vector3d::UnitX()).toRotationMatrix());
            return pose;
        };
        shutter.T_previous_keyframe = turned(angle).inverse();
        shutter.since_previous = shutter.earlier_interval = kDt;
        shutter.rows.turn.x() = (angle - before) / kDt;
        // What the first row sees of the turn; linear in it
        const auto seen = [&](double turn) {
            const RowMotion rows = shutter.motion(turned(turn).inverse());
            return turn + (0 - rows.reference_row) * rows.seconds_per_row * rows.turn.x();
        };
        const double still = seen(0), slope = (seen(1e-3) - still) / 1e-3;
        before = angle;
        angle = -still / slope;
    }
    EXPECT_LT(std::abs(angle), 2e-3);
}

/// Normal equations of one frame, residual by residual.
struct Evidence : PoseSystem {
    void add(const Vector6d& by_pose, double by_readout, double residual) {
        hessian += by_pose * by_pose.transpose();
        readout_mixed += by_readout * by_pose;
        gradient += residual * by_pose;
        readout_hessian += by_readout * by_readout;
        readout_gradient += by_readout * residual;
    }
};

Vector6d randomJacobian(std::mt19937& random) {
    Vector6d j;
    for (int k = 0; k < 6; ++k) j[k] = uniform(random, -500, 500);
    return j;
}

TEST(ReadoutEstimator, FindsAKnownReadoutTimeInLinearData) {
    std::mt19937 random(97);
    const double truth = 2.5e-5;  // s per row
    ReadoutEstimator estimator(1e-4, 0.95);
    EXPECT_EQ(estimator.secondsPerRow(), 0);
    EXPECT_NEAR(estimator.sigma(), 1e-4, 1e-12) << "of the prior";
    for (int frame = 0; frame < 60; ++frame) {
        Evidence evidence;
        Vector6d pose_error;
        for (int k = 0; k < 6; ++k) pose_error[k] = uniform(random, -0.01, 0.01);
        for (int i = 0; i < 300; ++i) {
            const Vector6d j = randomJacobian(random);
            const double by_readout = uniform(random, -1e5, 1e5);
            // The residual at no read-out time and a pose that is off: r = -(j e + by_readout s) + noise
            evidence.add(j, by_readout,
                         -(j.dot(pose_error) + by_readout * truth) + uniform(random, -0.3, 0.3));
        }
        estimator.add(evidence);
    }
    EXPECT_NEAR(estimator.secondsPerRow(), truth, 0.01 * truth);
    EXPECT_LT(estimator.sigma(), 1e-6);
}

// All frames that are tracked from a keyframe share its errors, which differ from keyframe to keyframe.
TEST(ReadoutEstimator, ErrorsOfOneKeyframeDoNotLeadItAstray) {
    std::mt19937 random(99);
    const double truth = 2.5e-5, astray = 2e-5;  // s per row
    ReadoutEstimator estimator(1e-4, SensorOptions().readout_memory);
    double largest_error = 0;
    for (int keyframe = 0; keyframe < 20; ++keyframe) {
        const double seems = truth + (keyframe % 2 == 0 ? astray : -astray);
        for (int frame = 0; frame < 27; ++frame) {
            Evidence evidence;
            evidence.hessian = Matrix6d::Identity() * 1e-6;
            for (int i = 0; i < 50; ++i) {
                const double by_readout = uniform(random, -1e5, 1e5);
                evidence.add(randomJacobian(random), by_readout, -by_readout * seems);
            }
            estimator.add(evidence);
            if (keyframe >= 10)
                largest_error = std::max(largest_error, std::abs(estimator.secondsPerRow() - truth));
        }
    }
    EXPECT_LT(largest_error, 0.2 * astray);
}

TEST(ReadoutEstimator, AFrameIsWorthWhatItAddsInProportionToWhatIsKnown) {
    std::mt19937 random(100);
    ReadoutEstimator estimator(1e-4, 1);
    Evidence evidence;
    for (int i = 0; i < 50; ++i) evidence.add(randomJacobian(random), uniform(random, -1e5, 1e5), 0);
    const double first = estimator.worth(evidence);
    EXPECT_GT(first, 100) << "the prior is wide";
    estimator.add(evidence);
    // Known n times over, once more adds 1 / n (and the prior)
    EXPECT_NEAR(estimator.worth(evidence), first / (first + 1), 1e-9);
    estimator.add(evidence);
    EXPECT_NEAR(estimator.worth(evidence), first / (2 * first + 1), 1e-9);
    evidence.hessian = -Matrix6d::Identity();
    EXPECT_EQ(estimator.worth(evidence), 0);
}

TEST(ReadoutEstimator, WhatThePoseExplainsAsWellTeachesNothing) {
    std::mt19937 random(98);
    ReadoutEstimator estimator(1e-4, 0.95);
    for (int frame = 0; frame < 30; ++frame) {
        Evidence evidence;
        evidence.hessian = Matrix6d::Identity() * 1e-6;
        for (int i = 0; i < 100; ++i) {
            const Vector6d j = randomJacobian(random);
            evidence.add(j, 200 * j[1], j[1] * 0.01);  // indistinguishable from moving along y
        }
        estimator.add(evidence);
    }
    EXPECT_LT(std::abs(estimator.secondsPerRow()), 1e-6);
}

TEST(ReadoutEstimator, BadEvidenceIsLeftOut) {
    ReadoutEstimator estimator(1e-4, 0.95);
    const Vector6d ones = Vector6d::Ones();
    estimator.add({Matrix6d::Zero(), ones, ones, 1, std::nan("")});
    estimator.add({-Matrix6d::Identity(), ones, ones, 1, 1});
    estimator.add({Matrix6d::Identity() * std::nan(""), ones, ones, 1, 1});
    EXPECT_EQ(estimator.secondsPerRow(), 0);
}

}  // namespace
}  // namespace roevo
