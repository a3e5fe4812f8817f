// What the odometry says of every frame: status, reason, and never a NaN.
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "core/support/status_run.h"

namespace roevo {
namespace {

using testing::room;
using testing::Sequence;
using testing::simulate;
using testing::smallRoom;

RgbdFrame black(double timestamp) {
    return {timestamp, cv::Mat::zeros(240, 320, CV_8UC1), cv::Mat::zeros(240, 320, CV_32FC1), cv::Mat()};
}

class OdometryStatus : public testing::StatusRun {};

TEST_F(OdometryStatus, ABlackFrameIsPredictedAndTrackingGoesOn) {
    feedRoom(0, 10);
    const FrameResult lost = feed(black(frameAt(10).timestamp));
    EXPECT_EQ(lost.status, FrameStatus::kPredicted);
    EXPECT_LT(errorAt(lost, 10), 0.01) << "constant velocity is a fair guess for one frame";
    const FrameResult found = feed(frameAt(11));
    EXPECT_EQ(found.status, FrameStatus::kOk) << found.reason;
    EXPECT_LT(errorAt(found, 11), 0.005);
    EXPECT_GT(lost.sigmaTranslation(), found.sigmaTranslation()) << "a guessed pose is worth less";
}

TEST_F(OdometryStatus, SeveralBlackFramesAreBridgedAndTheFramesAfterThemAreRight) {
    feedRoom(0, 10);
    for (int i = 10; i < 16; ++i)
        EXPECT_EQ(feed(black(frameAt(i).timestamp)).status, FrameStatus::kPredicted);
    for (int i = 16; i < 22; ++i) {
        const FrameResult result = feed(frameAt(i));
        EXPECT_EQ(result.status, FrameStatus::kOk) << i << " " << result.reason;
        EXPECT_LT(errorAt(result, i), 0.006) << i;
    }
}

TEST_F(OdometryStatus, ACameraThatStoodStillInTheDarkIsFoundWhereItStood) {
    // What was predicted while it was dark is wrong, and must not pull the frames after it
    constexpr int kLast = 11, kDark = 8;
    feedRoom(0, kLast + 1);
    const double step = frameAt(1).timestamp - frameAt(0).timestamp;
    double time = frameAt(kLast).timestamp;
    FrameResult dark;
    for (int i = 0; i < kDark; ++i) {
        dark = feed(black(time += step));
        EXPECT_EQ(dark.status, FrameStatus::kPredicted);
    }
    EXPECT_GT(errorAt(dark, kLast), 0.02) << "the prediction moves on";
    RgbdFrame frame = frameAt(kLast);
    frame.timestamp = (time += step);
    const FrameResult found = feed(frame);
    EXPECT_EQ(found.status, FrameStatus::kOk) << found.reason;
    EXPECT_LT(errorAt(found, kLast), 0.01);
    EXPECT_LT(errorAt(found, kLast), 5 * found.sigmaTranslation());
    for (int i = kLast + 1; i < 30; ++i) {
        frame = frameAt(i);
        frame.timestamp = (time += step);
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, FrameStatus::kOk) << i << " " << result.reason;
        EXPECT_LT(errorAt(result, i), 0.01) << i;
    }
}

TEST_F(OdometryStatus, TimeMayBeginBeforeZero) {
    for (int i = 0; i < 4; ++i) {
        RgbdFrame frame = frameAt(i);
        frame.timestamp = -5 + (frameAt(i).timestamp - frameAt(0).timestamp);
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk) << result.reason;
        EXPECT_LT(errorAt(result, i), 0.005) << i;
    }
    ASSERT_EQ(odometry_.trajectory().size(), 4U);
    EXPECT_EQ(odometry_.trajectory()[0].timestamp, -5);
}

TEST_F(OdometryStatus, AStartPoseThatIsNotFiniteIsRefused) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        Pose start = room().start();
        start.translation().y() = bad;
        EXPECT_THROW(Odometry(room().camera, OdometryOptions(), start), std::invalid_argument);
        start = room().start();
        start.setRotation(Eigen::Quaterniond(1, bad, 0, 0));
        EXPECT_THROW(Odometry(room().camera, OdometryOptions(), start), std::invalid_argument);
    }
}

TEST_F(OdometryStatus, AStartPoseWithoutARotationIsRefused) {
    const auto fault = [](const Eigen::Quaterniond& rotation) -> std::string {
        try {
            const Odometry odometry(room().camera, OdometryOptions(), {rotation, Eigen::Vector3d::Zero()});
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(fault({0, 0, 0, 0}).find("0 0 0 0"), std::string::npos) << "as an unset orientation of ROS";
    EXPECT_NE(fault({1e200, 1e200, 0, 0}), "");
    EXPECT_EQ(fault({2, 0, 0, 0}), "");
}

TEST_F(OdometryStatus, CovariancesKnowThatAllDepthsMayBeWrongByOneShare) {
    constexpr double kShare = 0.1;
    OdometryOptions exact, unsure;
    exact.sensor.depth_scale_sigma = 0;
    unsure.sensor.depth_scale_sigma = kShare;
    Odometry without(room().camera, exact, room().start()), with(room().camera, unsure, room().start());
    const auto expectByScale = [&](const Eigen::Vector3d& way, const Matrix6d& more) {
        Matrix6d expected = Matrix6d::Zero();
        expected.topLeftCorner<3, 3>() = kShare * kShare * way * way.transpose();
        EXPECT_GT(way.norm(), 0.02);
        EXPECT_LT((more - expected).norm(), 1e-9);
    };
    FrameResult last, reference;
    for (int i = 0; i < 20; ++i) {
        reference = without.processFrame(frameAt(i));
        last = with.processFrame(frameAt(i));
    }
    EXPECT_EQ(last.T_world_camera.matrix(), reference.T_world_camera.matrix()) << "poses do not depend on it";
    expectByScale(last.T_world_camera.translation() - room().start().translation(),
                  last.covariance - reference.covariance);
    const Pose motion = with.motion(5, 18);
    expectByScale(motion.linear().transpose() * motion.translation(),
                  with.motionCovariance(5, 18) - without.motionCovariance(5, 18));
}

TEST_F(OdometryStatus, RepeatedAndBackwardTimeStampsAreRejected) {
    feedRoom(0, 5);
    const FrameResult repeated = feed(frameAt(4));
    EXPECT_EQ(repeated.status, FrameStatus::kRejected);
    EXPECT_NE(repeated.reason.find("repeated"), std::string::npos);
    const FrameResult backward = feed(frameAt(2));
    EXPECT_EQ(backward.status, FrameStatus::kRejected);
    EXPECT_NE(backward.reason.find("backward"), std::string::npos);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        RgbdFrame frame = frameAt(5);
        frame.timestamp = bad;
        EXPECT_EQ(feed(frame).status, FrameStatus::kRejected);
    }
    feedRoom(5, 8);
    EXPECT_EQ(odometry_.trajectory().size(), 8U) << "rejected frames have no pose";
}

TEST_F(OdometryStatus, DamagedStampsCostTheirFrames) {
    feedRoom(0, 5);
    const double damaged[] = {-1e9, -5e11, 3e11, 5e11, 1e6, 1e12};
    for (const double by : damaged) {
        RgbdFrame frame = frameAt(5);
        frame.timestamp += by;
        EXPECT_EQ(feed(frame).status, FrameStatus::kRejected) << by;
    }
    feedRoom(6, 9);
    EXPECT_EQ(odometry_.trajectory().size(), 8U);
}

TEST_F(OdometryStatus, AnotherSizeOrTypeIsRejectedWithBothSizes) {
    feedRoom(0, 3);
    RgbdFrame frame = frameAt(3);
    frame.grey = cv::Mat::zeros(480, 640, CV_8UC1);
    const FrameResult grey = feed(frame);
    EXPECT_EQ(grey.status, FrameStatus::kRejected);
    EXPECT_NE(grey.reason.find("640x480"), std::string::npos);
    EXPECT_NE(grey.reason.find("320x240"), std::string::npos);
    frame = frameAt(3);
    frame.depth = cv::Mat::zeros(120, 160, CV_32FC1);
    EXPECT_NE(feed(frame).reason.find("160x120"), std::string::npos);
    frame = frameAt(3);
    frame.depth = cv::Mat::zeros(240, 320, CV_16UC1);
    EXPECT_EQ(feed(frame).status, FrameStatus::kRejected);
    frame = frameAt(3);
    frame.grey = cv::Mat::zeros(240, 320, CV_8UC3);
    EXPECT_EQ(feed(frame).status, FrameStatus::kRejected);
    frame.grey = cv::Mat();
    EXPECT_EQ(feed(frame).reason, "no colour image");
    frame.colour = cv::Mat::zeros(240, 320, CV_8UC3);
    EXPECT_EQ(feed(frame).reason, "no grey image beside the colour image");
    for (const int type : {CV_8UC4, CV_32FC3, CV_8UC1}) {
        frame = frameAt(3);
        frame.colour = cv::Mat::zeros(240, 320, type);
        EXPECT_NE(feed(frame).reason.find("colour image is not"), std::string::npos) << type;
    }
    frame.colour = cv::Mat::zeros(320, 240, CV_8UC3);
    EXPECT_NE(feed(frame).reason.find("240x320"), std::string::npos);
    feedRoom(3, 6);
}

TEST_F(OdometryStatus, AFirstStampThatCountsNoSecondsDoesNotSpoilTheRest) {
    // Nanoseconds, microseconds, milliseconds since 1970, and MRPT's time stamp that is none
    for (const double bad : {1e300, 1.7e18, 1.7e15, 1.7e12, -11644473600.0}) {
        RgbdFrame frame = frameAt(0);
        frame.timestamp = bad;
        const FrameResult result = feed(frame);
        EXPECT_EQ(result.status, FrameStatus::kRejected) << bad;
        EXPECT_NE(result.reason.find("seconds"), std::string::npos) << result.reason;
    }
    feedRoom(0, 3);
}

TEST_F(OdometryStatus, NoMotionIsKnownExactly) {
    feedRoom(0, 3);
    EXPECT_TRUE(odometry_.motionCovariance(1, 1).isZero(0));
    EXPECT_GT(odometry_.motionCovariance(1, 2).trace(), 0);
    EXPECT_THROW((void)odometry_.motionCovariance(3, 3), std::out_of_range);
}

TEST_F(OdometryStatus, AnIndexThatIsNoneIsNamedWithTheNumberOfFrames) {
    feedRoom(0, 3);
    const auto rejected = static_cast<std::size_t>(FrameResult().index);
    for (const auto& [index, named] : {std::pair{std::size_t{3}, "frame 3:"}, {rejected, "frame -1:"}})
        for (const bool covariance : {false, true}) try {
                if (covariance) (void)odometry_.motionCovariance(0, index);
                (void)odometry_.motion(0, index);
                FAIL() << index;
            } catch (const std::out_of_range& error) {
                const std::string text = error.what();
                EXPECT_NE(text.find(named), std::string::npos) << text;
                EXPECT_NE(text.find("3 frames have a pose"), std::string::npos) << text;
            }
}

TEST_F(OdometryStatus, ALongLossIsHeldAndReanchoredWithAReason) {
    feedRoom(0, 10);
    double time = frameAt(9).timestamp;
    const int bridged = OdometryOptions().loss.max_predicted;
    for (int i = 0; i < bridged; ++i)
        EXPECT_EQ(feed(black(time += 1 / 30.0)).status, FrameStatus::kPredicted);
    const FrameResult first = feed(black(time += 1 / 30.0));
    EXPECT_EQ(first.status, FrameStatus::kLost);
    const FrameResult second = feed(black(time += 1 / 30.0));
    EXPECT_EQ(second.status, FrameStatus::kLost);
    EXPECT_EQ((first.T_world_camera.matrix() - second.T_world_camera.matrix()).norm(), 0)
        << "the pose is held";
    // A view that has nothing to do with the keyframe
    auto elsewhere = smallRoom();
    elsewhere.scene = "corridor";
    const Sequence other = simulate(elsewhere, 4);
    std::size_t i = 0;
    FrameResult result;
    for (; i < 4; ++i) {
        RgbdFrame frame = other.frames[i];
        frame.timestamp = (time += 1 / 30.0);
        result = feed(frame);
        if (result.status == FrameStatus::kInitialised) break;
    }
    ASSERT_EQ(result.status, FrameStatus::kInitialised) << result.reason;
    EXPECT_NE(result.reason.find("re-anchored"), std::string::npos) << result.reason;
    EXPECT_TRUE(result.new_keyframe);
    EXPECT_LT((result.T_world_camera.translation() - second.T_world_camera.translation()).norm(), 1e-9)
        << "no silent jump";
    for (++i; i < 4; ++i) {
        RgbdFrame frame = other.frames[i];
        frame.timestamp = (time += 1 / 30.0);
        EXPECT_EQ(feed(frame).status, FrameStatus::kOk);
    }
}

TEST_F(OdometryStatus, FramesThatWereLostAreTrackedFromWhereTrackingBeginsAnew) {
    feedRoom(0, 10);
    const auto before = static_cast<std::ptrdiff_t>(odometry_.trajectory().size());
    auto elsewhere = smallRoom();
    elsewhere.scene = "corridor";
    const int bridged = OdometryOptions().loss.max_predicted;
    const Sequence other = simulate(elsewhere, bridged + 2);
    double time = frameAt(9).timestamp;
    std::vector<FrameStatus> statuses;
    for (RgbdFrame frame : other.frames) {
        frame.timestamp = (time += 1 / 30.0);
        statuses.push_back(feed(frame).status);
    }
    std::vector<FrameStatus> expected(static_cast<std::size_t>(bridged), FrameStatus::kPredicted);
    expected.push_back(FrameStatus::kInitialised);
    expected.push_back(FrameStatus::kOk);
    EXPECT_EQ(statuses, expected);
    const auto trajectory = odometry_.trajectory();
    const std::vector<StampedPose> final(trajectory.begin() + before, trajectory.end());
    ASSERT_EQ(final.size(), other.truth.size());
    for (std::size_t i = 0; i < final.size(); ++i) {
        const Pose estimated = final.back().T_world_camera.inverse() * final[i].T_world_camera;
        const Pose truth = other.truth.back().T_world_camera.inverse() * other.truth[i].T_world_camera;
        EXPECT_LT((estimated.translation() - truth.translation()).norm(), 0.004) << i;
    }
}

TEST_F(OdometryStatus, UnusableFirstFramesAreRejectedUntilOneWillDo) {
    const FrameResult dark = feed(black(0.1));
    EXPECT_EQ(dark.status, FrameStatus::kRejected);
    RgbdFrame blind = frameAt(0);
    blind.timestamp = 0.2;
    blind.depth = cv::Mat();
    EXPECT_NE(feed(blind).reason.find("depth"), std::string::npos);
    for (const double unit : {1e3, 1e-3}) {  // mm, km
        RgbdFrame wrong = frameAt(0);
        wrong.timestamp = unit > 1 ? 0.3 : 0.4;
        wrong.depth = cv::Mat(unit * wrong.depth);
        const std::string reason = feed(wrong).reason;
        EXPECT_NE(reason.find("are they in metres?"), std::string::npos) << reason;
    }
    EXPECT_TRUE(odometry_.trajectory().empty());
    EXPECT_TRUE(odometry_.keyframes().empty());
    feedRoom(0, 4);
    ASSERT_EQ(odometry_.keyframes().size(), 1U);
    EXPECT_EQ(odometry_.keyframes()[0].timestamp, frameAt(0).timestamp);
}

TEST_F(OdometryStatus, NoiseDoesNotThrowThePoseAbout) {
    feedRoom(0, 5);
    cv::theRNG().state = 5;
    for (int i = 5; i < 10; ++i) {
        RgbdFrame noise = black(frameAt(i).timestamp);
        cv::randu(noise.grey, 0, 256);
        cv::randu(noise.depth, 0.5, 5);
        EXPECT_LT(errorAt(feed(noise), i), 0.3) << i;
    }
}

TEST_F(OdometryStatus, TrajectoryIsSortedUniqueAndKeyframesAreOfIt) {
    feedRoom(0, 30);
    const auto trajectory = odometry_.trajectory();
    ASSERT_EQ(trajectory.size(), 30U);
    for (std::size_t i = 1; i < trajectory.size(); ++i)
        EXPECT_GT(trajectory[i].timestamp, trajectory[i - 1].timestamp);
    const auto keyframes = odometry_.keyframes();
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
        EXPECT_EQ(keyframes[k].id, static_cast<int>(k));
        EXPECT_TRUE(std::any_of(trajectory.begin(), trajectory.end(),
                                [&](const auto& pose) { return pose.timestamp == keyframes[k].timestamp; }));
    }
}

}  // namespace
}  // namespace roevo
