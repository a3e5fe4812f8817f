// The whole odometry on a small simulated room: no noise gives nearly no error, and what must not matter does
// not.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/support/simulated.h"
#include "core/support/sparse_depth.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::makeTwiceAsLarge;
using testing::positionError;
using testing::Sequence;
using testing::simulate;
using testing::smallRoom;
using testing::track;
using testing::TrackedRun;

const Sequence& clean() {
    static const Sequence sequence = simulate(smallRoom(), 40);
    return sequence;
}

void expectAllOk(const TrackedRun& run) {
    ASSERT_EQ(run.results.front().status, FrameStatus::kInitialised) << run.results.front().reason;
    for (std::size_t i = 1; i < run.results.size(); ++i) {
        EXPECT_EQ(run.results[i].status, FrameStatus::kOk) << "frame " << i << ": " << run.results[i].reason;
    }
}

TEST(OdometryAccuracy, WithoutNoiseTheErrorIsAFewMillimetres) {
    ASSERT_GT(pathLength(clean().truth), 0.2);
    for (const Mode mode : {Mode::kTracking, Mode::kCoarse}) {
        OdometryOptions options;
        options.mode = mode;
        const TrackedRun run = track(clean(), options);
        expectAllOk(run);
        RecordProperty(mode == Mode::kTracking ? "tr_mm" : "ct_mm",
                       std::to_string(1000 * positionError(run, clean())));
        EXPECT_LT(positionError(run, clean()), mode == Mode::kTracking ? 0.003 : 0.006) << toString(mode);
    }
}

TEST(OdometryAccuracy, ADepthInEverySixteenthPixelIsEnough) {
    Sequence sparse = clean();
    for (RgbdFrame& frame : sparse.frames) frame.depth = testing::everyNth(frame.depth, 4, 1);
    const TrackedRun run = track(sparse);
    expectAllOk(run);
    RecordProperty("mm", std::to_string(1000 * positionError(run, sparse)));
    EXPECT_LT(positionError(run, sparse), 0.005);
}

TEST(OdometryAccuracy, TheSameImageAgainDoesNotMoveThePose) {
    Sequence still;
    still.camera = clean().camera;
    for (int i = 0; i < 10; ++i) {
        still.frames.push_back(clean().frames.front());
        still.frames.back().timestamp = 1 + i / 30.0;
        still.truth.push_back(clean().truth.front());
    }
    const TrackedRun run = track(still);
    expectAllOk(run);
    for (const auto& result : run.results) {
        const Pose moved = still.start().inverse() * result.T_world_camera;
        EXPECT_LT(moved.translation().norm(), 2e-5);
        EXPECT_LT(rotationAngle(moved), 1e-5);
    }
    EXPECT_GT(run.results.back().matched_ratio, 0.95);
}

TEST(OdometryAccuracy, AWorldTwiceAsLargeGivesATrajectoryTwiceAsLarge) {
    Sequence large = clean();
    OdometryOptions options;
    makeTwiceAsLarge(large, options);
    const TrackedRun once = track(clean()), twice = track(large, options);
    expectAllOk(twice);
    for (std::size_t i = 0; i < once.results.size(); ++i) {
        const Pose &a = once.results[i].T_world_camera, &b = twice.results[i].T_world_camera;
        EXPECT_LT((2 * a.translation() - b.translation()).norm(), 1.5e-3) << i;
        EXPECT_LT(rotationAngle(a.inverse() * b), 5e-4) << i;
    }
}

TEST(OdometryAccuracy, GainAndOffsetHardlyMatter) {
    Sequence dim = clean();
    for (std::size_t i = 0; i < dim.frames.size(); ++i) {
        const double gain =
            0.75 + 0.15 * std::sin(0.3 * static_cast<double>(i));  // drifts from frame to frame
        dim.frames[i].grey = cv::Mat();                            // its own memory
        clean().frames[i].grey.convertTo(dim.frames[i].grey, CV_8U, gain, 10);
    }
    const TrackedRun run = track(dim);
    expectAllOk(run);
    RecordProperty("mm", std::to_string(1000 * positionError(run, dim)));
    EXPECT_LT(positionError(run, dim), 0.004);
}

TEST(OdometryAccuracy, BackwardsIsTheInverseMotion) {
    Sequence back = clean();
    std::reverse(back.frames.begin(), back.frames.end());
    std::reverse(back.truth.begin(), back.truth.end());
    for (std::size_t i = 0; i < back.frames.size(); ++i)
        back.frames[i].timestamp = clean().frames[i].timestamp;
    const TrackedRun forth = track(clean()), run = track(back);
    expectAllOk(run);
    const Pose there = forth.results.front().T_world_camera.inverse() * forth.results.back().T_world_camera;
    const Pose here = run.results.front().T_world_camera.inverse() * run.results.back().T_world_camera;
    const Pose round = there * here;
    RecordProperty("mm", std::to_string(1000 * round.translation().norm()));
    EXPECT_LT(round.translation().norm(), 0.008);
    EXPECT_LT(rotationAngle(round), 0.003);
}

TEST(OdometryAccuracy, StartPoseOnlyMovesTheTrajectory) {
    Pose start = Pose::Identity();
    start.translation() = Eigen::Vector3d(3, -2, 1);
    start.setRotation(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix());
    Odometry a(clean().camera, OdometryOptions()), b(clean().camera, OdometryOptions(), start);
    for (std::size_t i = 0; i < 12; ++i) {
        const Pose first = a.processFrame(clean().frames[i]).T_world_camera;
        const Pose second = b.processFrame(clean().frames[i]).T_world_camera;
        EXPECT_LT(((start * first).matrix() - second.matrix()).norm(), 1e-4);
    }
}

TEST(OdometryAccuracy, ADistortedLensIsUndone) {
    auto options = smallRoom();
    options.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};  // a Kinect's
    const Sequence sequence = simulate(options, 30);
    ASSERT_TRUE(sequence.camera.isDistorted());
    const TrackedRun run = track(sequence);
    expectAllOk(run);
    RecordProperty("mm", std::to_string(1000 * positionError(run, sequence)));
    EXPECT_LT(positionError(run, sequence), 0.004);
}

TEST(OdometryAccuracy, TwoRunsGiveTheSameBytes) {
    const TrackedRun a = track(clean()), b = track(clean());
    ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
    for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
        EXPECT_EQ(a.trajectory[i].T_world_camera.matrix(), b.trajectory[i].T_world_camera.matrix())
            << "frame " << i;
        EXPECT_EQ((a.results[i].covariance - b.results[i].covariance).norm(), 0);
    }
}

TEST(OdometryAccuracy, MapEdgesLieOnTheSurfaces) {
    Odometry odometry(clean().camera, OdometryOptions(), clean().start());
    (void)odometry.processFrame(clean().frames[0]);
    const EdgeMap map = odometry.map();
    ASSERT_GT(map.size(), 20U);
    const cv::Mat& depth = clean().frames[0].depth;
    const Pose T_camera_world = clean().start().inverse();
    int on_surface = 0, all = 0;
    for (const auto& edge : map) {
        EXPECT_EQ(edge.points.size(), edge.colours.size());
        EXPECT_EQ(edge.keyframe_id, 0);
        for (const auto& point : edge.points) {
            const Eigen::Vector3d p = T_camera_world * point.cast<double>();
            const Eigen::Vector2d pixel = clean().camera.project(p);
            double nearest = 1e9;  // of the depths within two pixels
            for (int dy = -2; dy <= 2; ++dy) {
                for (int dx = -2; dx <= 2; ++dx) {
                    const int u =
                        std::clamp(static_cast<int>(std::lround(pixel.x())) + dx, 0, depth.cols - 1);
                    const int v =
                        std::clamp(static_cast<int>(std::lround(pixel.y())) + dy, 0, depth.rows - 1);
                    nearest = std::min(nearest, std::abs(static_cast<double>(depth.at<float>(v, u)) - p.z()));
                }
            }
            ++all;
            if (nearest < 0.01 * p.z()) ++on_surface;
        }
    }
    EXPECT_GT(on_surface, 0.98 * all);
}

}  // namespace
}  // namespace roevo
