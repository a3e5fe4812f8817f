// A loop that is closed when a place is recognised: the same with any threads, in final and live poses, map
// and covariance.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/utility.hpp>

#include "core/support/simulated.h"
#include "odometry/frame_preparer.h"
#include "tracking/edge_points.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::Sequence;

constexpr int kRoundFrames = 112;  // about four more than once round the room

/// Once round the room, at 5 Hz. On the way depths grow too large and right again, so that the camera does
/// not arrive where it began.
const Sequence& roundTheRoom() {
    static const Sequence sequence = [] {
        simulator::SimulationOptions options = testing::smallRoom();
        options.path = simulator::PathKind::kWalk;
        options.frames = kRoundFrames;
        options.fps = 5;
        options.speed = 1;
        Sequence sequence = testing::simulate(options, kRoundFrames);
        for (int i = 0; i < 90; ++i) {
            cv::Mat& depth = sequence.frames[static_cast<std::size_t>(i)].depth;
            depth = cv::Mat(depth * (1 + 0.08 * std::pow(std::sin(i / 90.0 * 3.14159), 2)));
        }
        return sequence;
    }();
    return sequence;
}

struct LoopedRun {
    std::vector<FrameResult> results;
    std::vector<StampedPose> trajectory, live;
    EdgeMap map;
    int closed = 0, first_closed = 0;
};

LoopedRun run(const OdometryOptions& options) {
    Odometry odometry(roundTheRoom().camera, options, roundTheRoom().start());
    LoopedRun out;
    for (const RgbdFrame& frame : roundTheRoom().frames) {
        out.results.push_back(odometry.processFrame(frame));
        if (out.results.back().closed_at < 0) continue;
        if (out.closed++ == 0) out.first_closed = static_cast<int>(out.results.size()) - 1;
    }
    out.trajectory = odometry.trajectory();
    out.live = odometry.liveTrajectory();
    out.map = odometry.map();
    return out;
}

double endError(const std::vector<StampedPose>& poses) {
    return (poses.back().T_world_camera.translation() -
            roundTheRoom().truth.back().T_world_camera.translation())
        .norm();
}

const LoopedRun& withLoops() {
    static const LoopedRun result = run(OdometryOptions());
    return result;
}
const LoopedRun& withoutLoops() {
    static const LoopedRun result = [] {
        OdometryOptions options;
        options.mapping.close_loops = false;
        return run(options);
    }();
    return result;
}

TEST(LoopClosing, TheCameraIsBackWhereItBegan) {
    for (const LoopedRun* each : {&withLoops(), &withoutLoops()})
        for (std::size_t i = 1; i < each->results.size(); ++i)
            ASSERT_EQ(each->results[i].status, FrameStatus::kOk) << i << " " << each->results[i].reason;
    EXPECT_EQ(withoutLoops().closed, 0);
    EXPECT_GT(endError(withoutLoops().trajectory), 0.06) << "or the test asks for nothing";
    EXPECT_GT(withLoops().closed, 0);
    EXPECT_LT(endError(withLoops().trajectory), 0.02);
    EXPECT_LT(endError(withLoops().live), 0.02);
}

TEST(LoopClosing, TheFrameThatItTakesEffectWithSaysSo) {
    const FrameResult& closed = withLoops().results[static_cast<std::size_t>(withLoops().first_closed)];
    EXPECT_NE(closed.reason.find("a loop is closed to keyframe"), std::string::npos) << closed.reason;
    EXPECT_GT(closed.map_correction, 0.05);
    const FrameResult& before = withLoops().results[static_cast<std::size_t>(withLoops().first_closed) - 1];
    EXPECT_LT(closed.sigmaTranslation(), before.sigmaTranslation());
}

TEST(LoopClosing, WhatWasGoneWrongIsSharedOut) {
    // No two frames jump apart in the end, as they do live
    const auto jump = [](const std::vector<StampedPose>& poses) {
        double worst = 0;
        for (std::size_t i = 1; i < poses.size(); ++i) {
            const auto moved = [&](const std::vector<StampedPose>& of) {
                return of[i - 1].T_world_camera.inverse() * of[i].T_world_camera;
            };
            const Pose apart = moved(poses).inverse() * moved(roundTheRoom().truth);
            worst = std::max(worst, apart.translation().norm());
        }
        return worst;
    };
    EXPECT_GT(jump(withLoops().live), 0.05);
    EXPECT_LT(jump(withLoops().trajectory), 0.04);
}

/// Of the map's points that the last frame should see from where it truly is: the share that lies by an edge
/// of it.
double shareInPlace(const EdgeMap& map) {
    const Sequence& sequence = roundTheRoom();
    const OdometryOptions options;
    Frame last;
    last.images = sequence.frames.back();
    FramePreparer(sequence.camera, options).findEdges(last);
    const Points3 edges =
        liftEdges(last.edges, last.images.depth, sequence.camera, RowMotion(), options.edges, options.sensor)
            .points;
    const Pose T_camera_world = sequence.truth.back().T_world_camera.inverse();
    int seen = 0, in_place = 0;
    for (const MapEdge& edge : map) {
        for (const Eigen::Vector3f& point : edge.points) {
            const Eigen::Vector3d p = T_camera_world * point.cast<double>();
            const Eigen::Vector2d pixel = sequence.camera.project(p);
            const auto u = static_cast<int>(std::lround(pixel.x())),
                       v = static_cast<int>(std::lround(pixel.y()));
            if (p.z() < 0.1 || u < 0 || v < 0 || u >= sequence.camera.width || v >= sequence.camera.height)
                continue;
            if (std::abs(p.z() - static_cast<double>(last.images.depth.at<float>(v, u))) > 0.3) continue;
            ++seen;
            bool near = false;
            for (std::size_t i = 0; i < edges.size() && !near; ++i) near = (edges.at(i) - p).norm() < 0.03;
            in_place += near ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 500);
    return static_cast<double>(in_place) / seen;
}

TEST(LoopClosing, TheMapMovesWithTheKeyframes) {
    // Edges near the start were seen at both ends: with the loop closed they are in one place
    EXPECT_GT(shareInPlace(withLoops().map), 1.2 * shareInPlace(withoutLoops().map));
}

TEST(LoopClosing, IsTheSameWithAnyNumberOfThreads) {
    const testing::ThreadsRestored restored;
    for (const int threads : {1, 2, 4}) {
        cv::setNumThreads(threads);
        const LoopedRun again = run(OdometryOptions());
        ASSERT_EQ(again.trajectory.size(), withLoops().trajectory.size());
        for (std::size_t i = 0; i < again.trajectory.size(); ++i) {
            ASSERT_EQ(again.trajectory[i].T_world_camera.matrix(),
                      withLoops().trajectory[i].T_world_camera.matrix())
                << threads << " threads, frame " << i;
            ASSERT_EQ(again.live[i].T_world_camera.matrix(), withLoops().live[i].T_world_camera.matrix());
        }
    }
}

}  // namespace
}  // namespace roevo
