// What moves with the camera, such as the robot's own arm, is left out where a mask says so.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/support/simulated.h"
#include "edges/edge_extractor.h"

namespace roevo {
namespace {

using testing::Sequence;
using testing::TrackedRun;

const cv::Rect kArm(90, 130, 130, 110);

const Sequence& unmasked() {
    static const Sequence sequence = testing::simulate(testing::smallRoom(), 40);
    return sequence;
}

/// With a striped arm that stays where it is in the image, 0.5 m before the camera.
Sequence withArm() {
    Sequence sequence = unmasked();
    for (RgbdFrame& frame : sequence.frames) {
        frame.grey = frame.grey.clone();
        frame.depth = frame.depth.clone();
        for (int y = kArm.y; y < kArm.br().y; ++y)
            for (int x = kArm.x; x < kArm.br().x; ++x) {
                frame.grey.at<std::uint8_t>(y, x) = (x + 2 * y) / 10 % 2 == 0 ? 30 : 220;
                frame.depth.at<float>(y, x) = 0.5F;
            }
    }
    return sequence;
}

cv::Mat armMask() {
    cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(255));
    mask(kArm).setTo(0);
    return mask;
}

Sequence masked(Sequence sequence) {
    for (RgbdFrame& frame : sequence.frames) frame.mask = armMask();
    return sequence;
}

TEST(Masks, AnArmThatIsMaskedCostsNoMoreThanTheViewThatItCovers) {
    const TrackedRun misled = track(withArm()), run = track(masked(withArm())),
                     covered = track(masked(unmasked()));
    EXPECT_GT(testing::positionError(misled, unmasked()), 0.05) << "else the arm is no test";
    EXPECT_EQ(run.count(FrameStatus::kOk), 39);
    EXPECT_LT(testing::positionError(run, unmasked()), 0.005);
    // Nothing of it counts: not its edges, not its depth, not the threshold that its contrast would raise
    EXPECT_LT(testing::positionError(run, unmasked()), 1.5 * testing::positionError(covered, unmasked()));
}

TEST(Masks, NoEdgeOfTheMapIsOfWhatIsMasked) {
    const Sequence sequence = masked(withArm());
    Odometry odometry(sequence.camera, OdometryOptions(), sequence.start());
    for (const RgbdFrame& frame : sequence.frames) EXPECT_TRUE(odometry.processFrame(frame).hasPose());
    const auto poses = odometry.keyframes();
    std::size_t points = 0;
    for (const MapEdge& edge : odometry.keyframeEdges()) {
        const Pose T_world_keyframe = poses.at(static_cast<std::size_t>(edge.keyframe_id)).T_world_camera;
        for (const Eigen::Vector3f& point : edge.points) {
            const Eigen::Vector3d seen = T_world_keyframe.inverse() * Eigen::Vector3d(point.cast<double>());
            EXPECT_GT(seen.z(), 0.6);
            ++points;
        }
    }
    EXPECT_GT(points, 500U);
}

TEST(Masks, AWhiteMaskAndNoneAreTheSame) {
    Sequence sequence = unmasked();
    const TrackedRun plain = track(sequence);
    for (RgbdFrame& frame : sequence.frames) frame.mask = cv::Mat(240, 320, CV_8UC1, cv::Scalar(1));
    const TrackedRun white = track(sequence);
    for (std::size_t i = 0; i < plain.results.size(); ++i)
        EXPECT_TRUE(plain.results[i].T_world_camera.matrix() == white.results[i].T_world_camera.matrix())
            << i;
}

TEST(Masks, TheCallersImagesStayAsTheyAre) {
    Sequence sequence = masked(withArm());
    Odometry odometry(sequence.camera, OdometryOptions(), sequence.start());
    RgbdFrame shared = sequence.frames[0];
    EXPECT_EQ(odometry.processFrame(odometry.prepareFrame(std::move(shared))).status,
              FrameStatus::kInitialised);
    EXPECT_EQ(sequence.frames[0].depth.at<float>(kArm.y + 20, kArm.x + 20), 0.5F);
    EXPECT_EQ(cv::countNonZero(sequence.frames[0].mask != armMask()), 0);
}

TEST(Masks, OfFramesWithoutDepthOrOfNothingAtAll) {
    Sequence sequence = masked(withArm());
    sequence.frames[20].depth = cv::Mat();
    sequence.frames[30].mask = cv::Mat::zeros(240, 320, CV_8UC1);
    const TrackedRun run = track(sequence);
    EXPECT_EQ(run.results[20].status, FrameStatus::kOk) << run.results[20].reason;
    EXPECT_EQ(run.results[30].status, FrameStatus::kPredicted);
    EXPECT_EQ(run.results[39].status, FrameStatus::kOk) << run.results[39].reason;
    EXPECT_LT(testing::positionError(run, unmasked()), 0.01);
}

TEST(Masks, AnotherSizeOrTypeIsRejected) {
    Sequence sequence = unmasked();
    sequence.frames[3].mask = cv::Mat::zeros(480, 640, CV_8UC1);
    sequence.frames[4].mask = cv::Mat::zeros(240, 320, CV_32FC1);
    const TrackedRun run = track(sequence);
    EXPECT_EQ(run.results[3].status, FrameStatus::kRejected);
    EXPECT_EQ(run.results[3].reason, "mask is 640x480 but the camera is 320x240");
    EXPECT_EQ(run.results[4].status, FrameStatus::kRejected);
    EXPECT_EQ(run.results[4].reason, "mask is not 8-bit with one channel");
    EXPECT_EQ(run.results[5].status, FrameStatus::kOk);
}

}  // namespace
}  // namespace roevo
