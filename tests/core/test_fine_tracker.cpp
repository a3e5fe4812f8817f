// Fine tracking on a simulated pair of frames: which start it takes, and where it ends.
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/simulated.h"
#include "roevo/edges/edge_extractor.h"
#include "roevo/tracking/fine_tracker.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

using namespace testing;

/// Frame 0 of a small room as the keyframe, and frame 4 to be tracked against it.
class FineTracking : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { sequence_ = new Sequence(simulate(smallRoom(), 5)); }
    static void TearDownTestSuite() { delete sequence_; }

    void SetUp() override {
        const auto lift = [&](const RgbdFrame& frame) {
            OrganizedEdges edges;
            EdgeExtractor(options_.edges).extract(frame.grey, edges);
            return edges;
        };
        keyframe_.edges = liftEdges(lift(sequence_->frames[0]), sequence_->frames[0].depth, sequence_->camera,
                                    RowMotion(), options_.edges, options_.sensor);
        keyframe_.median_depth = static_cast<double>(keyframe_.edges.medianDepth());
        edges_ = lift(sequence_->frames[4]);
        grid_.build(edges_, sequence_->camera.width, sequence_->camera.height);
        pyramid_.build(sequence_->frames[4].grey, 1);
        truth_ = sequence_->truth[4].T_world_camera.inverse() * sequence_->truth[0].T_world_camera;
    }
    FineResult trackFrom(const Pose& start, const Pose& likely, const RollingShutter& shutter = {}) {
        FineTracker tracker(options_.fine, options_.edges, options_.sensor);
        FineFrame frame;
        frame.edges = &edges_;
        frame.grid = &grid_;
        frame.pyramid = &pyramid_;
        frame.depth = &sequence_->frames[4].depth;
        frame.raw_camera = frame.camera = &sequence_->camera;
        const Pose better = tracker.betterStart(keyframe_, frame, start, likely, shutter);
        return tracker.track(keyframe_, frame, better, {likely, 1, 1}, shutter, Brightness());
    }
    double errorOf(const FineResult& result) const {
        return (truth_.inverse() * result.T_current_keyframe).translation().norm();
    }
    static Pose turned(double degrees) {
        Vector6d turn = Vector6d::Zero();
        turn[4] = degrees * kDegree;
        return poseIncrement(turn);
    }

    /// Moves edge points of the current frame across their edges, one edge to one side and the next to the
    /// other, by how far they move in so many seconds while the camera does this.
    void smear(const RowMotion& rows, double seconds) {
        const PinholeCamera& camera = sequence_->camera;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const int u = static_cast<int>(std::lround(edges_.x[i])),
                      v = static_cast<int>(std::lround(edges_.y[i]));
            const float z = sequence_->frames[4].depth.at<float>(v, u);
            if (!(z > 0)) continue;
            const Eigen::Vector3d point = camera.backProject(u, v, static_cast<double>(z));
            const Eigen::Vector2d moved =
                camera.project(point + seconds * rows.pointVelocity(point)) - camera.project(point);
            const double across = std::abs(moved.x() * static_cast<double>(edges_.normal_x[i]) +
                                           moved.y() * static_cast<double>(edges_.normal_y[i])) *
                                  (edges_.edge_of[i] % 2 == 0 ? 1 : -1);
            edges_.x[i] += static_cast<float>(across) * edges_.normal_x[i];
            edges_.y[i] += static_cast<float>(across) * edges_.normal_y[i];
        }
        grid_.build(edges_, camera.width, camera.height);
    }

    static Sequence* sequence_;
    OdometryOptions options_;
    Keyframe keyframe_;
    OrganizedEdges edges_;
    EdgeGrid grid_;
    ImagePyramid pyramid_;
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
    smear(rows, 0.003);
    const double trusting = [&] {
        options_.sensor.blur_time = 0;
        return errorOf(trackFrom(turned(0.3) * truth_, turned(0.3) * truth_, shutter));
    }();
    options_.sensor.blur_time = SensorOptions().blur_time;
    const double careful = errorOf(trackFrom(turned(0.3) * truth_, turned(0.3) * truth_, shutter));
    EXPECT_LT(careful, 0.8 * trusting) << trusting;
}

}  // namespace
}  // namespace roevo
