// Fine tracking on a simulated pair of frames: which start it takes, and where it ends.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/support/simulated.h"
#include "odometry/frame_preparer.h"
#include "tracking/fine_tracker.h"
#include "tracking/se3.h"
#include "tracking/tracker.h"

namespace roevo {
namespace {

using namespace testing;

/// Frame 0 of a small room as the keyframe, and frame 4 to be tracked against it.
class FineTracking : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { sequence_ = new Sequence(simulate(smallRoom(), 5)); }
    static void TearDownTestSuite() { delete sequence_; }

    void SetUp() override {
        const PinholeCamera& camera = sequence_->camera;
        Frame first;
        first.images = sequence_->frames[0];
        FramePreparer(camera, options_).findEdges(first);
        keyframe_.edges =
            liftEdges(first.edges, first.images.depth, camera, RowMotion(), options_.edges, options_.sensor);
        keyframe_.median_depth = static_cast<double>(keyframe_.edges.medianDepth());
        frame_.images = sequence_->frames[4];
        FramePreparer(camera, options_).findEdges(frame_);
        truth_ = sequence_->truth[4].T_world_camera.inverse() * sequence_->truth[0].T_world_camera;
    }
    /// Tracked, and assessed at the pose that was found.
    FineResult trackFrom(const Pose& start, const Pose& likely, const RollingShutter& shutter = {}) {
        FineTracker tracker(sequence_->camera, options_);
        const Pose better = tracker.chooseInitialPose(keyframe_, frame_, start, likely, shutter);
        const FineResult found = tracker.track(keyframe_, frame_, better, {likely}, shutter, Brightness());
        const Pose& pose = found.T_current_keyframe;
        FineResult assessed = tracker.assess(keyframe_, frame_, pose, shutter.motion(pose));
        assessed.converged = assessed.converged && found.converged;
        return assessed;
    }
    double errorOf(const FineResult& result) const {
        return (truth_.inverse() * result.T_current_keyframe).translation().norm();
    }
    static Pose turned(double degrees) {
        Vector6d turn = Vector6d::Zero();
        turn[4] = degrees * kDegree;
        return poseIncrement(turn);
    }

    /// Moves edge points of the current frame across their edges, each edge to a side of its own, by how far
    /// they move in so many seconds while the camera does this.
    void smear(const RowMotion& rows, double seconds, std::mt19937& random) {
        const PinholeCamera& camera = sequence_->camera;
        OrganizedEdges& edges = frame_.edges;
        std::vector<double> sides;
        for (int e = 0; e < edges.numEdges(); ++e) sides.push_back(random() % 2 == 0 ? 1 : -1);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const int u = static_cast<int>(std::lround(edges.x[i])),
                      v = static_cast<int>(std::lround(edges.y[i]));
            const float z = frame_.images.depth.at<float>(v, u);
            if (!(z > 0)) continue;
            const Eigen::Vector3d point = camera.backProject(u, v, static_cast<double>(z));
            const Eigen::Vector2d moved =
                camera.project(point + seconds * rows.pointVelocity(point)) - camera.project(point);
            const double across = std::abs(moved.x() * static_cast<double>(edges.normal_x[i]) +
                                           moved.y() * static_cast<double>(edges.normal_y[i])) *
                                  at(sides, edges.edge_of[i]);
            edges.x[i] += static_cast<float>(across) * edges.normal_x[i];
            edges.y[i] += static_cast<float>(across) * edges.normal_y[i];
        }
        frame_.grid.build(edges, camera.width, camera.height);
    }

    static Sequence* sequence_;
    OdometryOptions options_;
    Keyframe keyframe_;
    Frame frame_;
    Pose truth_ = Pose::Identity();
};
Sequence* FineTracking::sequence_ = nullptr;

TEST_F(FineTracking, FindsTheMotionFromNearby) {
    ASSERT_GT(truth_.translation().norm(), 0.01);
    const FineResult result = trackFrom(turned(0.3) * truth_, turned(0.3) * truth_);
    ASSERT_TRUE(result.converged);
    EXPECT_LT(errorOf(result), 0.002);
}

TEST_F(FineTracking, AGoodGuessIsTakenWhenCoarseTrackingWentAstray) {
    const Pose astray = turned(8) * truth_;
    const FineResult lost = trackFrom(astray, astray);
    ASSERT_TRUE(!lost.converged || errorOf(lost) > 0.02) << "else the case tests nothing";
    const FineResult result = trackFrom(astray, turned(0.3) * truth_);
    ASSERT_TRUE(result.converged);
    EXPECT_LT(errorOf(result), 0.002);
}

TEST_F(FineTracking, ABadGuessDoesNotReplaceAGoodStart) {
    const FineResult result = trackFrom(turned(0.3) * truth_, turned(8) * truth_);
    ASSERT_TRUE(result.converged);
    EXPECT_LT(errorOf(result), 0.002);
}

TEST_F(FineTracking, APoseIsAssessedByTheEdgesItWasFoundWithAsByThoseAssociatedAnew) {
    FineTracker tracker(sequence_->camera, options_), fresh(sequence_->camera, options_);
    const Pose pose =
        tracker.track(keyframe_, frame_, turned(0.3) * truth_, {truth_}, {}, Brightness()).T_current_keyframe;
    const FineResult own = tracker.assess(keyframe_, frame_, pose, {}),
                     anew = fresh.assess(keyframe_, frame_, pose, {});
    EXPECT_NEAR(own.inliers, anew.inliers, 0.02 * anew.inliers);
    EXPECT_NEAR(own.matched_ratio, anew.matched_ratio, 0.01);
    // Far from there they are of no use
    const Pose away = turned(2) * pose;
    EXPECT_EQ(tracker.assess(keyframe_, frame_, away, {}).inliers,
              fresh.assess(keyframe_, frame_, away, {}).inliers);
}

TEST_F(FineTracking, EdgesThatMoveAcrossThemselvesAreTrustedLess) {
    // The camera rolls: what is far from the image's middle, and what points at it least, is off the most
    constexpr double kInterval = 1. / 30;
    Vector6d roll = Vector6d::Zero();
    roll[5] = -1.5 * kInterval;  // rad
    RollingShutter shutter;
    shutter.T_previous_keyframe = poseIncrement(roll).inverse() * truth_;
    shutter.since_previous = kInterval;
    const RowMotion rows = shutter.motion(truth_);
    EXPECT_NEAR(rows.turn.z(), 1.5, 0.01);
    options_.fine.photometric_weight = 0;  // edges only
    const OrganizedEdges sharp = frame_.edges;
    std::mt19937 random(1);
    double trusting = 0, careful = 0;
    for (int k = 0; k < 40; ++k) {
        frame_.edges = sharp;
        smear(rows, 0.003, random);
        options_.sensor.blur_time = 0;
        trusting += errorOf(trackFrom(turned(0.3) * truth_, turned(0.3) * truth_, shutter));
        options_.sensor.blur_time = SensorOptions().blur_time;
        careful += errorOf(trackFrom(turned(0.3) * truth_, turned(0.3) * truth_, shutter));
    }
    EXPECT_LT(careful, 0.8 * trusting) << trusting;
}

TEST_F(FineTracking, WhatAVelocityOfTheRowsMovesIsWhatTrackingWithAnotherOneFinds) {
    options_.fine.photometric_weight = 0;  // edges only
    FineTracker tracker(sequence_->camera, options_);
    RollingShutter shutter;
    shutter.rows.seconds_per_row = 0.015 / sequence_->camera.height;
    shutter.rows.reference_row = sequence_->camera.height / 2.;
    const auto track = [&](int axis, double speed) {
        RowMotion rows = shutter.motion(truth_);
        (axis < 3 ? rows.velocity[axis] : rows.turn[axis - 3]) = speed;
        RollingShutter moving{rows};
        moving.velocity_variance[axis] = 1;
        return tracker.track(keyframe_, frame_, truth_, {truth_}, moving, Brightness());
    };
    for (int axis = 0; axis < 6; ++axis) {
        constexpr double kStep = 0.2;  // m/s, rad/s
        const Pose apart =
            track(axis, kStep).T_current_keyframe * track(axis, -kStep).T_current_keyframe.inverse();
        const Eigen::AngleAxisd turn(apart.linear());
        Vector6d moved;
        moved << apart.translation(), turn.angle() * turn.axis();
        moved /= 2 * kStep;
        const Matrix6d of_rows = track(axis, 0).of_velocity;
        EXPECT_GT(moved.norm(), 1e-4) << axis << ": else there is nothing to see";
        for (const int first : {0, 3}) {
            const double length = moved.segment<3>(first).norm();
            EXPECT_NEAR(std::sqrt(of_rows.block<3, 3>(first, first).trace()), length, 0.2 * length)
                << axis << " " << first;
        }
        EXPECT_GT(moved.dot(of_rows * moved), 0.75 * moved.squaredNorm() * of_rows.trace())
            << axis << ": in another direction";
    }
    // Against a keyframe whose motion is not known, an unknown read-out time adds as much as one so long
    shutter.velocity_variance.setOnes();
    const auto tracked = [&] {
        return tracker.track(keyframe_, frame_, truth_, {truth_}, shutter, Brightness());
    };
    const Matrix6d known = tracked().of_velocity;
    shutter.readout_sigma = 0.75 * shutter.rows.seconds_per_row;
    const FineResult either = tracked();
    EXPECT_LT((either.of_velocity - known).norm(), 1e-4 * known.norm());
    EXPECT_LT((either.uncertainty.common - 1.25 * 1.25 * known).norm(), 1e-4 * known.norm());
    // Else as much as the one moved otherwise than the other
    keyframe_.row_motion.velocity.x() = 0.1;
    shutter.rows.velocity = truth_.linear() * keyframe_.row_motion.velocity + Eigen::Vector3d(0.2, 0, 0);
    shutter.velocity_variance = Vector6d::Unit(0);
    const FineResult otherwise = tracked();
    EXPECT_GT(otherwise.of_velocity.norm(), 0);
    EXPECT_LT((otherwise.uncertainty.common - 0.15 * 0.15 * otherwise.of_velocity).norm(),
              1e-3 * otherwise.uncertainty.common.norm());
    shutter.rows.velocity = truth_.linear() * keyframe_.row_motion.velocity;
    EXPECT_LT(tracked().uncertainty.common.norm(), 1e-4 * otherwise.uncertainty.common.norm());
    shutter.rows.seconds_per_row = shutter.readout_sigma = 0;
    const FineResult at_once = tracked();
    EXPECT_EQ(at_once.of_velocity, Matrix6d::Zero());
    EXPECT_EQ(at_once.uncertainty.common, Matrix6d::Zero());
}

// The frame was said to be read at once, also to those that are tracked from it where it becomes a keyframe
TEST_F(FineTracking, AgainstAKeyframeWhoseRowsAreNotKnownThoseOfTheFrameAreToldAllTheSame) {
    Prediction prediction;
    prediction.prior.mean = truth_;
    prediction.T_reference_camera = prediction.T_reference_last = truth_.inverse();
    RollingShutter& shutter = prediction.shutter;
    shutter.rows.seconds_per_row = 2e-5;
    shutter.since_previous = 4. / 30;
    shutter.velocity_variance.setOnes();
    ASSERT_FALSE(keyframe_.row_motion.known());
    const Tracking tracking = Tracker(sequence_->camera, options_).track(keyframe_, frame_, prediction);
    ASSERT_TRUE(tracking.tracked);
    EXPECT_EQ(tracking.rows.seconds_per_row, shutter.rows.seconds_per_row);
    const RowMotion moved = shutter.motion(truth_);
    EXPECT_LT((tracking.rows.velocity - moved.velocity).norm(), 0.05 * moved.velocity.norm());
    EXPECT_GT(tracking.pose.uncertainty.common.trace(), 0) << "that both moved alike is a guess";
}

}  // namespace
}  // namespace roevo
