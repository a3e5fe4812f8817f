// The two halves of Odometry::processFrame().
#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <future>
#include <optional>
#include <stdexcept>

#include "core/support/simulated.h"
#include "odometry/frame_preparer.h"

namespace roevo {
namespace {

using testing::Sequence;
using testing::TrackedRun;

/// With frames of every kind: one frozen, one that repeats its stamp, one black, one that goes back in time.
const Sequence& spoilt() {
    static const Sequence sequence = [] {
        Sequence room = testing::simulate(testing::smallRoom(), 60);
        room.frames[12].grey = room.frames[11].grey;
        room.frames[20].timestamp = room.frames[19].timestamp;
        room.frames[30].grey = cv::Mat::zeros(240, 320, CV_8UC1);
        room.frames[40].timestamp = room.frames[35].timestamp;
        room.frames[50].depth = cv::Mat(2, 2, CV_32FC1, cv::Scalar(1));
        return room;
    }();
    return sequence;
}

bool sameBits(const Pose& a, const Pose& b) {
    const Eigen::Matrix4d left = a.matrix(), right = b.matrix();
    return std::memcmp(left.data(), right.data(), sizeof left) == 0;
}

void expectSame(const TrackedRun& run, const TrackedRun& usual) {
    ASSERT_EQ(run.results.size(), usual.results.size());
    for (std::size_t i = 0; i < run.results.size(); ++i) {
        const FrameResult &result = run.results[i], &other = usual.results[i];
        EXPECT_EQ(result.status, other.status) << i;
        EXPECT_EQ(result.reason, other.reason) << i;
        EXPECT_EQ(result.timestamp, other.timestamp) << i;
        EXPECT_EQ(result.new_keyframe, other.new_keyframe) << i;
        EXPECT_TRUE(sameBits(result.T_world_camera, other.T_world_camera)) << i;
    }
    ASSERT_EQ(run.trajectory.size(), usual.trajectory.size());
    for (std::size_t i = 0; i < run.trajectory.size(); ++i)
        EXPECT_TRUE(sameBits(run.trajectory[i].T_world_camera, usual.trajectory[i].T_world_camera)) << i;
}

TEST(PreparedFrames, MadeAheadInAnotherThreadGiveTheSameBits) {
    const TrackedRun usual = track(spoilt());
    EXPECT_GE(usual.count(FrameStatus::kRejected), 3);
    EXPECT_GE(usual.count(FrameStatus::kPredicted), 1);
    constexpr std::size_t kAhead = 3;
    Odometry odometry(spoilt().camera, OdometryOptions(), spoilt().start());
    TrackedRun run;
    std::deque<PreparedFrame> waiting;
    std::future<PreparedFrame> coming;
    for (const RgbdFrame& frame : spoilt().frames) {
        coming = std::async(std::launch::async, [&] { return odometry.prepareFrame(frame); });
        if (waiting.size() == kAhead) {
            run.results.push_back(odometry.processFrame(std::move(waiting.front())));
            waiting.pop_front();
        }
        waiting.push_back(coming.get());
    }
    for (PreparedFrame& frame : waiting) run.results.push_back(odometry.processFrame(std::move(frame)));
    run.trajectory = odometry.trajectory();
    expectSame(run, usual);
}

TEST(PreparedFrames, AllInOneThreadGivesTheSameBits) {
    OdometryOptions options;
    options.threads = 1;
    expectSame(track(spoilt(), options), track(spoilt()));
}

TEST(PreparedFrames, ImagesThatAreKeptGiveTheSameBitsAndStayAsTheyAre) {
    Odometry odometry(spoilt().camera, OdometryOptions(), spoilt().start());
    TrackedRun run;
    std::vector<cv::Mat> before;
    for (std::size_t i = 0; i < spoilt().frames.size(); ++i) {
        const RgbdFrame& frame = spoilt().frames[i];
        before.push_back(frame.grey.clone());
        // These are others' images, too: copies of other frames must not come into them
        run.results.push_back(odometry.processFrame(i % 3 == 0 ? odometry.prepareFrame(frame)
                                                               : odometry.prepareFrame(RgbdFrame(frame))));
    }
    run.trajectory = odometry.trajectory();
    expectSame(run, track(spoilt()));
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(cv::norm(before[i], spoilt().frames[i].grey, cv::NORM_INF), 0) << i;
}

TEST(PreparedFrames, TheTimeOfBothHalvesIsCounted) {
    Odometry odometry(spoilt().camera, OdometryOptions(), spoilt().start());
    const FrameResult result = odometry.processFrame(odometry.prepareFrame(spoilt().frames.front()));
    EXPECT_GT(result.ms.edges, 0);
    EXPECT_GE(result.ms.total, result.ms.edges);
}

TEST(PreparedFrames, OneThatWasUsedOrIsLateIsNotTracked) {
    Odometry odometry(spoilt().camera, OdometryOptions(), spoilt().start());
    PreparedFrame first = odometry.prepareFrame(spoilt().frames[0]),
                  second = odometry.prepareFrame(spoilt().frames[1]);
    EXPECT_EQ(odometry.processFrame(std::move(second)).status, FrameStatus::kInitialised);
    EXPECT_EQ(odometry.processFrame(std::move(first)).status, FrameStatus::kRejected);
    EXPECT_THROW((void)odometry.processFrame(PreparedFrame()), std::logic_error);
    Odometry other(spoilt().camera, OdometryOptions(), spoilt().start());
    EXPECT_THROW((void)other.processFrame(odometry.prepareFrame(spoilt().frames[2])), std::logic_error);
    EXPECT_EQ(odometry.processFrame(odometry.prepareFrame(spoilt().frames[3])).status, FrameStatus::kOk);
}

TEST(PreparedFrames, OneOfAnOdometryThatIsNoMoreIsRefused) {
    std::optional<Odometry> odometry(std::in_place, spoilt().camera, OdometryOptions(), spoilt().start());
    for (int i = 0; i < 30; ++i) {  // now and then the new one is where the old one was
        PreparedFrame stale = odometry->prepareFrame(spoilt().frames[0]);
        odometry.reset();
        odometry.emplace(spoilt().camera, OdometryOptions(), spoilt().start());
        EXPECT_THROW((void)odometry->processFrame(std::move(stale)), std::logic_error);
    }
}

TEST(PreparedFrames, TheLongestEdgesAreKeptAsTheyAreAndInTheirOrder) {
    OrganizedEdges edges;
    float next = 0;
    for (const int length : {3, 7, 2, 5, 5}) {
        for (int i = 0; i < length; ++i, ++next) {
            edges.addPoint(next, 2 * next, 1, 0, 5);
            edges.normal_x.push_back(next);
            edges.normal_y.push_back(-next);
        }
        edges.finishEdge();
    }
    OrganizedEdges all = edges;
    keepLongest(all, 22);
    EXPECT_EQ(all.x, edges.x);
    keepLongest(edges, 14);  // of two of 5 points the first; nothing shorter takes the place that is left
    ASSERT_EQ(edges.numEdges(), 2);
    ASSERT_EQ(edges.size(), 12u);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto number = static_cast<float>(i < 7 ? 3 + i : 5 + i);
        EXPECT_EQ(edges.x[i], number);
        EXPECT_EQ(edges.y[i], 2 * number);
        EXPECT_EQ(edges.normal_x[i], number);
        EXPECT_EQ(edges.normal_y[i], -number);
        EXPECT_EQ(edges.edge_of[i], i < 7 ? 0 : 1);
    }
}

TEST(PreparedFrames, ImagesFullOfEdgesAreTrackedFromAsManyAsAnySceneHas) {
    const PinholeCamera camera = spoilt().camera;
    Odometry odometry(camera, OdometryOptions());
    const std::size_t most = static_cast<std::size_t>(camera.width * camera.height) / 12;
    for (int i = 0; i < 3; ++i) {
        RgbdFrame frame;
        frame.timestamp = i / 30.0;
        frame.grey.create(camera.height, camera.width, CV_8UC1);
        for (int u = 0; u < camera.width; ++u) frame.grey.col(u) = (u + i) / 3 % 2 == 0 ? 30 : 220;
        frame.depth = cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(1.5));
        const FrameResult result = odometry.processFrame(frame);
        EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk) << result.reason;
        EXPECT_LE(result.num_points, static_cast<int>(most));
        EXPECT_GT(result.num_points, static_cast<int>(most) / 2) << "there are more than these";
    }
}

}  // namespace
}  // namespace roevo
