// Frames whose depth is missing, scarce, damaged or contradicts what the keyframe has.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "core/support/status_run.h"

namespace roevo {
namespace {

using testing::room;

class FrameDepth : public testing::StatusRun {};

TEST_F(FrameDepth, AFrameWithoutDepthIsTracked) {
    feedRoom(0, 8);
    RgbdFrame frame = frameAt(8);
    frame.depth = cv::Mat();
    const FrameResult empty = feed(frame);
    EXPECT_EQ(empty.status, FrameStatus::kOk) << empty.reason;
    EXPECT_LT(errorAt(empty, 8), 0.006);
    frame = frameAt(9);
    frame.depth = cv::Mat::zeros(240, 320, CV_32FC1);
    const FrameResult zero = feed(frame);
    EXPECT_EQ(zero.status, FrameStatus::kOk) << zero.reason;
    EXPECT_LT(errorAt(zero, 9), 0.006);
    EXPECT_FALSE(zero.new_keyframe);
    feedRoom(10, 13);
}

// As little as the flying pixels of an outline are.
TEST_F(FrameDepth, AHandfulOfWrongDepthsContradictsNothing) {
    feedRoom(0, 8);
    for (int i = 8; i < 16; ++i) {
        RgbdFrame frame = frameAt(i);
        frame.depth = cv::Mat::zeros(240, 320, CV_32FC1);
        const cv::Rect scrap(30 + (i - 8) % 4 * 75, 50 + (i - 8) / 4 * 100, 25, 25);
        frame.depth(scrap) = 0.6 * frameAt(i).depth(scrap);
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, FrameStatus::kOk) << i;
        EXPECT_EQ(result.reason.find("contradicts"), std::string::npos) << i << ": " << result.reason;
        EXPECT_LT(errorAt(result, i), 0.006) << i;
    }
}

TEST_F(FrameDepth, AfterAGapAPoseIsConfirmedByDepthOrSaidToBePredicted) {
    feedRoom(0, 8);
    RgbdFrame frame = frameAt(13);  // five frames were dropped
    frame.depth = cv::Mat();
    EXPECT_EQ(feed(frame).status, FrameStatus::kPredicted) << "nothing confirms it";
    const FrameResult confirmed = feed(frameAt(14));
    EXPECT_EQ(confirmed.status, FrameStatus::kOk) << confirmed.reason;
    EXPECT_FALSE(confirmed.reason.empty());
    EXPECT_LT(errorAt(confirmed, 14), 0.006);
    feedRoom(15, 18);
}

TEST_F(FrameDepth, AScrapOfDepthMakesNoKeyframe) {
    OdometryOptions options;
    options.keyframe.max_rotation_deg = 0.3;
    Odometry undisturbed(room().camera, options, room().start());
    std::vector<double> with_all_depth;
    for (int i = 0; i < 20; ++i) with_all_depth.push_back(errorAt(undisturbed.processFrame(frameAt(i)), i));
    odometry_ = Odometry(room().camera, options, room().start());
    for (int i = 0; i < 20; ++i) {
        RgbdFrame frame = frameAt(i);
        const bool scrap = i >= 8 && i < 16;
        if (scrap) {
            frame.depth = cv::Mat::zeros(240, 320, CV_32FC1);
            const cv::Rect corner(20, 150, 100, 80);
            frameAt(i).depth(corner).copyTo(frame.depth(corner));
        }
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk) << i;
        EXPECT_LT(errorAt(result, i), std::max(0.006, 1.04 * with_all_depth[static_cast<std::size_t>(i)]))
            << i;
        EXPECT_FALSE(scrap && result.new_keyframe) << i;
        EXPECT_TRUE(i != 16 || result.new_keyframe) << "due since long";
        if (i == 12) {
            EXPECT_NE(result.reason.find("edge points with depth"), std::string::npos) << result.reason;
        }
    }
}

TEST_F(FrameDepth, NotANumberInDepthIsAHole) {
    for (int i = 0; i < 6; ++i) {
        RgbdFrame frame = frameAt(i);
        frame.depth.rowRange(60, 120).setTo(std::numeric_limits<float>::quiet_NaN());
        frame.depth.rowRange(120, 140).setTo(std::numeric_limits<float>::infinity());
        frame.depth.rowRange(140, 150).setTo(-1);
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk) << result.reason;
        EXPECT_LT(errorAt(result, i), 0.01);
    }
    for (const auto& edge : odometry_.map()) {
        for (const auto& point : edge.points) EXPECT_TRUE(point.allFinite());
    }
}

TEST_F(FrameDepth, DepthThatContradictsTheKeyframeIsLeftOutAndNamed) {
    for (const bool noise : {true, false}) {
        odometry_ = Odometry(room().camera, OdometryOptions(), room().start());
        feedRoom(0, 10);
        for (int i = 10; i < 15; ++i) {
            RgbdFrame frame = frameAt(i);
            frame.depth = 2 * frame.depth;
            if (noise) cv::randu(frame.depth, 0.5, 5.0);
            const FrameResult result = feed(frame);
            EXPECT_EQ(result.status, FrameStatus::kOk) << result.reason;
            EXPECT_NE(result.reason.find("depth image contradicts"), std::string::npos) << result.reason;
            EXPECT_LT(errorAt(result, i), 0.01) << "the edges alone hold the camera";
            EXPECT_FALSE(result.new_keyframe);
        }
        for (int i = 15; i < 20; ++i) {
            const FrameResult result = feed(frameAt(i));
            EXPECT_EQ(result.status, FrameStatus::kOk);
            EXPECT_EQ(result.reason, "");
            EXPECT_LT(errorAt(result, i), 0.005);
        }
    }
}

TEST_F(FrameDepth, APoseThatFewEdgesHoldAndDepthContradictsIsNotCalledTracked) {
    feedRoom(0, 10);
    RgbdFrame frame = frameAt(10);
    frame.depth = 1.5 * frame.depth;
    // What is left may be tracked, but tells too little against the depth
    frame.grey.colRange(0, 190).setTo(90);
    const FrameResult doubtful = feed(frame);
    EXPECT_EQ(doubtful.status, FrameStatus::kPredicted) << doubtful.reason;
    EXPECT_NE(doubtful.reason.find("depth image contradicts"), std::string::npos) << doubtful.reason;
    const FrameResult found = feed(frameAt(11));
    EXPECT_EQ(found.status, FrameStatus::kOk) << found.reason;
    EXPECT_LT(errorAt(found, 11), 0.005);
}

}  // namespace
}  // namespace roevo
