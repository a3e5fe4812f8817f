// Losing the camera and finding it again by what keyframes look like: gaps, other rooms, tracks that join.
#include <gtest/gtest.h>

#include "core/support/simulated.h"

namespace roevo {
namespace {

using testing::Sequence;
using testing::simulate;

const Sequence& livingroom() {
    static const Sequence sequence = [] {
        simulator::SimulationOptions options;
        options.useKinectNoise();
        return simulate(options, 130);
    }();
    return sequence;
}
const Sequence& otherRoom() {
    static const Sequence sequence = [] {
        simulator::SimulationOptions options;
        options.scene = "corridor";
        options.useKinectNoise();
        return simulate(options, 40);
    }();
    return sequence;
}

class Relocalisation : public ::testing::TestWithParam<Mode> {
  protected:
    Relocalisation() : odometry_(livingroom().camera, options(), livingroom().start()) {}
    static OdometryOptions options() {
        OdometryOptions options;
        options.mode = GetParam();
        return options;
    }
    /// Shows a frame at a later time.
    FrameResult show(const RgbdFrame& frame) {
        time_ += 1 / 30.0;
        RgbdFrame copy = frame;
        copy.timestamp = time_;
        const FrameResult result = odometry_.processFrame(copy);
        EXPECT_TRUE(result.T_world_camera.isFinite());
        EXPECT_TRUE(result.covariance.allFinite());
        return result;
    }
    FrameResult showRoom(std::size_t i) { return show(livingroom().frames[i]); }
    static double errorOf(const Pose& pose, std::size_t i) {
        return (pose.translation() - livingroom().truth[i].T_world_camera.translation()).norm();
    }
    double time_ = 100;
    Odometry odometry_;
};

TEST_P(Relocalisation, AfterAGapTheCameraIsFoundWhereItWasBefore) {
    for (std::size_t i = 0; i < 130; ++i)
        ASSERT_EQ(showRoom(i).status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk);
    time_ += 2;
    const FrameResult found = showRoom(10);
    EXPECT_EQ(found.status, FrameStatus::kOk) << found.reason;
    EXPECT_NE(found.reason, "") << "a jump is told";
    EXPECT_LT(errorOf(found.T_world_camera, 10), 0.02) << found.reason;
    for (std::size_t i = 11; i < 20; ++i) {
        const FrameResult result = showRoom(i);
        EXPECT_EQ(result.status, FrameStatus::kOk) << result.reason;
        EXPECT_LT(errorOf(result.T_world_camera, i), 0.02);
    }
}

TEST_P(Relocalisation, AnotherRoomIsNoPlaceOfThisOne) {
    for (std::size_t i = 0; i < 60; ++i) (void)showRoom(i);
    time_ += 2;
    int begun = 0;
    for (const RgbdFrame& frame : otherRoom().frames) {
        const FrameResult result = show(frame);
        EXPECT_EQ(result.reason.find("found again"), std::string::npos) << result.reason;
        EXPECT_EQ(result.reason.find("joined"), std::string::npos) << result.reason;
        if (result.status == FrameStatus::kInitialised) ++begun;
    }
    EXPECT_EQ(begun, 1) << "a track of its own";
    // And back: the first track goes on
    time_ += 2;
    FrameResult back;
    for (std::size_t i = 50; i < 60; ++i) back = showRoom(i);
    EXPECT_EQ(back.status, FrameStatus::kOk) << back.reason;
    EXPECT_LT(errorOf(back.T_world_camera, 59), 0.02);
}

TEST_P(Relocalisation, ATrackThatWasLeftIsJoinedByTheOlderOne) {
    for (std::size_t i = 0; i < 40; ++i) (void)showRoom(i);
    time_ += 3;
    int begun = 0;
    const std::size_t first = 129;
    for (std::size_t i = first; i > 115; --i) begun += showRoom(i).status == FrameStatus::kInitialised;
    ASSERT_EQ(begun, 1) << "an unknown place";
    time_ += 3;
    bool found = false, joined = false;
    for (std::size_t i = 20; i < 130; ++i) {
        const FrameResult result = showRoom(i);
        found = found || result.reason.find("found again") != std::string::npos;
        joined = joined || (found && result.reason.find("joined") != std::string::npos);
    }
    EXPECT_TRUE(found);
    EXPECT_TRUE(joined);
    const auto poses = odometry_.trajectory();
    ASSERT_GT(poses.size(), 54u);
    EXPECT_LT(errorOf(poses[53].T_world_camera, 116), 0.05) << "the track that was left";
}

TEST_P(Relocalisation, ATrackThatWasBegunAnewIsJoinedWhenAKeyframeIsRecognised) {
    // From the middle: the end of the path is seen first as an unknown place, and leads back to what is known
    for (std::size_t i = 0; i < 40; ++i) (void)showRoom(i);
    time_ += 3;
    bool joined = false;
    FrameResult last;
    for (std::size_t i = 129; i > 20; i -= 1) {
        last = showRoom(i);
        joined = joined || last.reason.find("joined") != std::string::npos ||
                 last.reason.find("found again") != std::string::npos;
    }
    EXPECT_TRUE(joined);
    EXPECT_EQ(last.status, FrameStatus::kOk) << last.reason;
    EXPECT_LT(errorOf(last.T_world_camera, 21), 0.02);
    const auto poses = odometry_.trajectory();
    ASSERT_EQ(poses.size(), 40U + 109U);
    double worst = 0;
    for (std::size_t k = 60; k < poses.size(); ++k)  // those that were tracked before the join moved with it
        worst = std::max(worst, errorOf(poses[k].T_world_camera, 129 - (k - 40)));
    EXPECT_LT(worst, 0.03);
}

TEST_P(Relocalisation, FramesWithoutAPoseAreInterpolatedInTheEnd) {
    for (std::size_t i = 0; i < 30; ++i) (void)showRoom(i);
    const RgbdFrame black{0, cv::Mat::zeros(480, 640, CV_8UC1), cv::Mat::zeros(480, 640, CV_32FC1), {}};
    for (int i = 0; i < 6; ++i) EXPECT_EQ(show(black).status, FrameStatus::kPredicted);
    for (std::size_t i = 36; i < 45; ++i) EXPECT_EQ(showRoom(i).status, FrameStatus::kOk);
    const auto poses = odometry_.trajectory();
    for (std::size_t i = 30; i < 36; ++i) EXPECT_LT(errorOf(poses[i].T_world_camera, i), 0.01) << i;
}

INSTANTIATE_TEST_SUITE_P(Modes, Relocalisation, ::testing::Values(Mode::kTracking, Mode::kBundleAdjustment));

}  // namespace
}  // namespace roevo
