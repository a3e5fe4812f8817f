// Stages that an experiment replaces: with copies of ROEVO's own nothing changes, and what they say counts.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/support/simulated.h"
#include "roevo/odometry_stages.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

const testing::Sequence& room() {
    static const testing::Sequence sequence = testing::simulate(testing::smallRoom(), 30);
    return sequence;
}

std::vector<FrameResult> run(const OdometryOptions& options, const OdometryStages& stages) {
    Odometry odometry(room().camera, options, room().start(), stages);
    std::vector<FrameResult> results;
    for (const RgbdFrame& frame : room().frames) results.push_back(odometry.processFrame(frame));
    return results;
}

void expectSame(const std::vector<FrameResult>& a, const std::vector<FrameResult>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].status, b[i].status) << i;
        EXPECT_EQ(a[i].new_keyframe, b[i].new_keyframe) << i;
        EXPECT_LT((a[i].T_world_camera.matrix() - b[i].T_world_camera.matrix()).norm(), 1e-9) << i;
        EXPECT_LT((a[i].covariance - b[i].covariance).norm(), 1e-6 * a[i].covariance.norm() + 1e-15) << i;
        EXPECT_NEAR(a[i].matched_ratio, b[i].matched_ratio, 1e-3) << i;
    }
}

TEST(OdometryStages, FineTrackingPutInFromOutsideChangesNothing) {
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        OdometryOptions options;
        options.mode = mode;
        FineTracker tracker(options.fine, options.edges, options.sensor);
        int calls = 0;
        OdometryStages stages;
        stages.registration = [&](const Keyframe& keyframe, const FineFrame& frame, const Pose& T_start,
                                  const PosePrior& prior, const RollingShutter& shutter,
                                  const Brightness& brightness) {
            ++calls;
            EXPECT_EQ(cv::countNonZero(frame.mask->mask), static_cast<int>(frame.mask->pixels.size()));
            return tracker.track(keyframe, frame, T_start, prior, shutter, brightness);
        };
        expectSame(run(options, OdometryStages()), run(options, stages));
        EXPECT_GE(calls, 29);
    }
}

TEST(OdometryStages, PointsPutInFromOutsideChangeNothing) {
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    OdometryStages stages;
    stages.photometric_points = [&](const KeyframeView& view) {
        return samplePhotometricPoints(view.edges, view.pyramid, options.coarse.max_points);
    };
    expectSame(run(options, OdometryStages()), run(options, stages));
}

TEST(OdometryStages, ARegistrationThatFailsLosesTheFrame) {
    OdometryStages stages;
    stages.registration = [](const Keyframe&, const FineFrame&, const Pose& T_start, const PosePrior&,
                             const RollingShutter&, const Brightness&) {
        FineResult result;
        result.T_current_keyframe = T_start;
        return result;
    };
    OdometryOptions options;
    options.mode = Mode::kTracking;
    const std::vector<FrameResult> results = run(options, stages);
    EXPECT_EQ(results[1].status, FrameStatus::kPredicted);
    EXPECT_NE(results[1].reason, "");
}

TEST(OdometryStages, APoseThatLeavesTheEdgesIsNotTracked) {
    OdometryStages stages;
    stages.registration = [](const Keyframe&, const FineFrame&, const Pose& T_start, const PosePrior&,
                             const RollingShutter&, const Brightness&) {
        Vector6d away = Vector6d::Zero();
        away[4] = 40 * kDegree;
        FineResult result;
        result.T_current_keyframe = poseIncrement(away) * T_start;
        result.converged = true;
        return result;
    };
    OdometryOptions options;
    options.mode = Mode::kTracking;
    EXPECT_EQ(run(options, stages)[1].status, FrameStatus::kPredicted);
}

TEST(OdometryStages, WithoutPointsCoarseTrackingSaysSo) {
    OdometryStages stages;
    stages.photometric_points = [](const KeyframeView&) { return PhotometricPoints(); };
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    const std::vector<FrameResult> results = run(options, stages);
    EXPECT_EQ(results[1].status, FrameStatus::kPredicted);
    EXPECT_NE(results[1].reason.find("too few points"), std::string::npos) << results[1].reason;
}

double strangeClock() {
    static double now = 0;
    return now += 1000;
}
TEST(OdometryStages, TimesAreTheClocksThatWasPutIn) {
    OdometryOptions options;
    options.mode = Mode::kTracking;
    OdometryStages stages;
    stages.clock = strangeClock;
    const std::vector<FrameResult> results = run(options, stages);
    EXPECT_EQ(results[1].ms.edges, 1000);
    EXPECT_EQ(results[1].ms.coarse, 1000);
    EXPECT_EQ(results[1].ms.fine, 1000);
    EXPECT_EQ(results[1].ms.total, 7000);
    expectSame(run(options, OdometryStages()), results);
}

}  // namespace
}  // namespace roevo
