// The baselines of roevo-compare: a method that is wrapped wrongly loses for the wrong reason. Exact images
// give nearly the exact motion, whatever the camera; bad frames are said to be bad and do no harm.
#include <gtest/gtest.h>

#include <limits>
#include <list>
#include <opencv2/core.hpp>

#include "analytic_room.h"
#include "core/support/simulated.h"
#include "method.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::AnalyticRoom;

constexpr double kRate = 30;  ///< frames per second

PinholeCamera plainCamera() {
    PinholeCamera camera;
    camera.width = 320;
    camera.height = 240;
    camera.fx = camera.fy = 262;
    camera.cx = 159.5;
    camera.cy = 119.5;
    return camera;
}

/// Of the plain camera, in memory of its own.
cv::Mat uniformDepth(float metres) {
    return cv::Mat(240, 320, CV_32FC1, cv::Scalar(metres));
}

/// What the method may be off by in an exact world.
struct Baseline {
    const char* name;
    double room_ate;      ///< share of the path, of the simulated room
    double motion_error;  ///< share of the motion, over a few frames
    double still_motion;  ///< m and rad after ten times the same image
};

void PrintTo(const Baseline& baseline, std::ostream* out) {
    *out << baseline.name;
}

class Baselines : public ::testing::TestWithParam<Baseline> {
  protected:
    void SetUp() override {
        for (const MethodInfo& info : knownMethods())
            if (info.name == GetParam().name && !info.unavailable.empty()) GTEST_SKIP() << info.unavailable;
    }
    static std::unique_ptr<Method> make(const PinholeCamera& camera = plainCamera()) {
        return makeMethod(GetParam().name, camera, OdometryOptions());
    }
};

/// Frames seen along T^0, T^1, T^2 … by `camera`; kept, since all methods see the same.
const std::vector<RgbdFrame>& walk(const Pose& step, int count, const PinholeCamera& camera = plainCamera()) {
    struct Walk {
        Pose step;
        PinholeCamera camera;
        std::vector<RgbdFrame> frames;
    };
    static std::list<Walk> walks;
    for (const Walk& walk : walks)
        if (walk.step.isApprox(step, 0) && walk.camera == camera &&
            walk.frames.size() == static_cast<std::size_t>(count))
            return walk.frames;
    walks.push_back({step, camera, {}});
    Pose T_world_camera = Pose::Identity();
    for (int i = 0; i < count; ++i) {
        walks.back().frames.push_back(AnalyticRoom::frame(camera, T_world_camera, 100 + i / kRate));
        T_world_camera = T_world_camera * step;
    }
    return walks.back().frames;
}

Pose stepOf(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
    Pose step = Pose::Identity();
    step.translation() = translation;
    if (rotation.norm() > 0)
        step.setRotation(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix());
    return step;
}

Pose power(const Pose& step, int n) {
    Pose all = Pose::Identity();
    for (int i = 0; i < n; ++i) all = all * step;
    return all;
}

/// Runs all frames, which must all be tracked, and returns the last pose.
Pose trackAll(Method& method, const std::vector<RgbdFrame>& frames) {
    Pose last = Pose::Identity();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const MethodFrame result = method.processFrame(frames[i]);
        EXPECT_TRUE(result.tracked) << "frame " << i << ": " << result.reason;
        EXPECT_EQ(result.reason, "");
        EXPECT_EQ(result.stage_ms.size(), method.stages().size());
        if (!result.T_world_camera) {
            ADD_FAILURE() << "frame " << i << " has no pose";
            return last;
        }
        if (i == 0) {
            EXPECT_TRUE(result.T_world_camera->matrix().isIdentity(0));
        }
        last = *result.T_world_camera;
    }
    return last;
}

const testing::Sequence& simulatedRoom() {
    static const testing::Sequence sequence = testing::simulate(testing::smallRoom(), 16);
    return sequence;
}

/// ATE as a share of the path, all frames tracked.
double roomAte(const std::string& name) {
    const testing::Sequence& room = simulatedRoom();
    const auto method = makeMethod(name, room.camera, OdometryOptions());
    std::vector<StampedPose> trajectory;
    for (const RgbdFrame& frame : room.frames) {
        const MethodFrame result = method->processFrame(frame);
        EXPECT_TRUE(result.tracked) << result.reason;
        trajectory.push_back({frame.timestamp, result.T_world_camera.value_or(Pose::Identity())});
    }
    EXPECT_GT(pathLength(room.truth), 0.1);
    const double share = evaluate(room.truth, trajectory).ate.translation.rmse / pathLength(room.truth);
    ::testing::Test::RecordProperty("ate_share", std::to_string(share));
    return share;
}

TEST_P(Baselines, FollowTheSimulatedRoom) {
    EXPECT_LT(roomAte(GetParam().name), GetParam().room_ate);
}

// The class is that of difodo-240, which takes the other tests.
TEST(Difodo480, FollowsTheSimulatedRoom) {
    for (const MethodInfo& info : knownMethods())
        if (info.name == "difodo-480" && !info.unavailable.empty()) GTEST_SKIP() << info.unavailable;
    EXPECT_LT(roomAte("difodo-480"), 0.022);
}

// An alignment of trajectories would hide a mirrored axis or a motion taken backwards.
TEST_P(Baselines, KnowEveryAxisAndItsSign) {
    constexpr int kFrames = 4;
    constexpr double kShift = 0.03, kTurn = 0.015;  // m and rad between frames
    double worst = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d unit = (axis == 1 ? -1 : 1) * Eigen::Vector3d::Unit(axis);
        const Pose moved = trackAll(*make(), walk(stepOf(kShift * unit, Eigen::Vector3d::Zero()), kFrames));
        const Eigen::Vector3d travelled = kShift * (kFrames - 1) * unit;
        worst = std::max(worst, (moved.translation() - travelled).norm() / travelled.norm());

        const Pose turn = stepOf(Eigen::Vector3d::Zero(), kTurn * unit);
        const Pose turned = trackAll(*make(), walk(turn, kFrames));
        const Pose off = power(turn, kFrames - 1).inverse() * turned;
        worst = std::max(worst, rotationAngle(off) / (kTurn * (kFrames - 1)));
    }
    RecordProperty("worst_share", std::to_string(worst));
    EXPECT_LT(worst, GetParam().motion_error);
}

TEST_P(Baselines, TheSameImageAgainIsNoMotion) {
    std::vector<RgbdFrame> frames(10, AnalyticRoom::frame(plainCamera(), Pose::Identity(), 0));
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].timestamp = static_cast<double>(i) / kRate;
    const Pose last = trackAll(*make(), frames);
    RecordProperty("motion", std::to_string(last.translation().norm()));
    EXPECT_LT(last.translation().norm(), GetParam().still_motion);
    EXPECT_LT(rotationAngle(last), GetParam().still_motion);
}

// Some of the libraries know a field of view only, or one size of image.
TEST_P(Baselines, AnyCameraGivesTheSameMotion) {
    PinholeCamera shifted = plainCamera(), distorted = plainCamera(), wide = plainCamera();
    shifted.cx += 35;
    shifted.cy -= 25;
    shifted.fx = 300;
    distorted.distortion = {0.26, -0.95, -0.005, 0.003, 1.16};  // as of TUM's fr1
    wide.width = 370;
    wide.height = 229;
    wide.fx = wide.fy = 363;
    wide.cx = 178;
    wide.cy = 111;
    const Pose step = stepOf({0.02, -0.015, 0.02}, {0.008, -0.01, 0.006});
    constexpr int kFrames = 4;
    const Pose truth = power(step, kFrames - 1);
    double worst = 0;
    for (const PinholeCamera& camera : {plainCamera(), shifted, distorted, wide}) {
        const Pose last = trackAll(*make(camera), walk(step, kFrames, camera));
        const Pose off = truth.inverse() * last;
        worst = std::max({worst, off.translation().norm() / truth.translation().norm(),
                          rotationAngle(off) / rotationAngle(truth)});
    }
    RecordProperty("worst_share", std::to_string(worst));
    EXPECT_LT(worst, GetParam().motion_error);
}

TEST_P(Baselines, AFrameWithoutDepthIsBridgedAndDoesNoHarm) {
    const Pose step = stepOf({0.02, 0, 0.02}, {0, 0.01, 0});
    std::vector<RgbdFrame> frames = walk(step, 7);
    frames[3].depth = uniformDepth(0);
    frames[4].depth = uniformDepth(std::numeric_limits<float>::quiet_NaN());
    const auto method = make();
    double worst = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const MethodFrame result = method->processFrame(frames[i]);
        ASSERT_TRUE(result.T_world_camera);
        ASSERT_TRUE(result.T_world_camera->matrix().allFinite());
        if (i == 3 || i == 4) {
            EXPECT_FALSE(result.tracked);
            EXPECT_EQ(result.reason, "too little depth");
        } else {
            EXPECT_TRUE(result.tracked) << i << ": " << result.reason;
        }
        if (i == 0) continue;
        const Eigen::Vector3d truth = power(step, static_cast<int>(i)).translation();
        worst = std::max(worst, (result.T_world_camera->translation() - truth).norm() / truth.norm());
    }
    RecordProperty("worst_share", std::to_string(worst));
    EXPECT_LT(worst, GetParam().motion_error);
}

TEST_P(Baselines, TheWorldBeginsWithTheFirstFrameThatCanBeUsed) {
    const Pose step = stepOf({0, 0, 0.03}, Eigen::Vector3d::Zero());
    std::vector<RgbdFrame> frames = walk(step, 3);
    frames[0].depth = uniformDepth(0);
    const auto method = make();
    const MethodFrame first = method->processFrame(frames[0]);
    EXPECT_FALSE(first.tracked);
    EXPECT_FALSE(first.T_world_camera);
    EXPECT_EQ(first.reason, "too little depth");
    const MethodFrame second = method->processFrame(frames[1]);
    ASSERT_TRUE(second.tracked);
    EXPECT_TRUE(second.T_world_camera->matrix().isIdentity(0));
    const MethodFrame third = method->processFrame(frames[2]);
    ASSERT_TRUE(third.tracked);
    EXPECT_NEAR(third.T_world_camera->translation().z(), 0.03, 0.03 * GetParam().motion_error);
}

TEST_P(Baselines, BadFramesAreRefusedWithAReason) {
    const std::vector<RgbdFrame>& frames = walk(stepOf({0, 0, 0.03}, Eigen::Vector3d::Zero()), 3);
    const auto method = make();
    ASSERT_TRUE(method->processFrame(frames[0]).tracked);
    ASSERT_TRUE(method->processFrame(frames[1]).tracked);
    std::vector<std::pair<RgbdFrame, std::string>> bad(6, {frames[2], ""});
    bad[0].first.timestamp = frames[1].timestamp;
    bad[0].second = "repeated time stamp";
    bad[1].first.timestamp = frames[0].timestamp;
    bad[1].second = "time stamp goes backward";
    bad[2].first.timestamp = std::numeric_limits<double>::quiet_NaN();
    bad[2].second = "time stamp is not finite";
    bad[3].first.depth = cv::Mat();
    bad[3].second = "no depth image";
    bad[4].first.depth = frames[2].depth(cv::Rect(0, 0, 160, 120)).clone();
    bad[4].second = "depth image is 160x120 but the camera is 320x240";
    bad[5].first.grey = cv::Mat();
    bad[5].second = "no colour image";
    for (const auto& [frame, reason] : bad) {
        const MethodFrame result = method->processFrame(frame);
        EXPECT_FALSE(result.tracked);
        EXPECT_FALSE(result.T_world_camera);
        EXPECT_EQ(result.reason, reason);
        EXPECT_EQ(result.stage_ms.size(), method->stages().size());
    }
    const MethodFrame after = method->processFrame(frames[2]);
    ASSERT_TRUE(after.tracked) << after.reason;
    EXPECT_NEAR(after.T_world_camera->translation().z(), 0.06, 0.06 * GetParam().motion_error);
}

TEST_P(Baselines, LongIntervalsHaveNoSayInTheMotion) {
    const Pose step = stepOf({0.02, 0, 0.02}, {0, 0.01, 0});
    std::vector<RgbdFrame> frames = walk(step, 7);
    for (std::size_t i = 3; i < frames.size(); ++i) frames[i].timestamp += 2;
    for (std::size_t i = 5; i < frames.size(); ++i) frames[i].timestamp += 1e5;
    const Pose truth = power(step, 6), last = trackAll(*make(), frames);
    const double share =
        std::max((last.translation() - truth.translation()).norm() / truth.translation().norm(),
                 rotationAngle(truth.inverse() * last) / rotationAngle(truth));
    RecordProperty("worst_share", std::to_string(share));
    EXPECT_LT(share, GetParam().motion_error);
}

// What a stamp too early says of the speed must not be carried on.
TEST_P(Baselines, AnIntervalOfNearlyNothingCostsOneStepAtMost) {
    const Pose step = stepOf({0.02, 0, 0.02}, {0, 0.01, 0});
    std::vector<RgbdFrame> frames = walk(step, 7);
    frames[3].timestamp = frames[2].timestamp + 1e-6;
    const auto method = make();
    MethodFrame last;
    for (const RgbdFrame& frame : frames) last = method->processFrame(frame);
    const Eigen::Vector3d truth = power(step, 6).translation();
    ASSERT_TRUE(last.tracked) << last.reason;
    const double off = (last.T_world_camera->translation() - truth).norm();
    RecordProperty("off_m", std::to_string(off));
    EXPECT_LT(off, step.translation().norm() + GetParam().motion_error * truth.norm());
}

// Depth as good as none, values that are no depth, and a wall that leaves the motion open.
TEST_P(Baselines, NothingMakesANumberThatIsNotFinite) {
    const PinholeCamera camera = plainCamera();
    const RgbdFrame room = AnalyticRoom::frame(camera, Pose::Identity(), 0);
    cv::Mat strip = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
    strip.rowRange(100, 108) = room.depth.rowRange(100, 108) + 0;
    cv::Mat left = room.depth.clone(), right = room.depth.clone();
    left.colRange(150, 320) = 0;
    right.colRange(0, 170) = 0;
    cv::Mat noise(camera.height, camera.width, CV_32FC1);
    cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0.5, 5);
    const auto infinite = std::numeric_limits<float>::infinity();
    const auto method = make();
    ASSERT_TRUE(method->processFrame(room).tracked);
    double time = 0;
    for (const cv::Mat& depth :
         {uniformDepth(2), uniformDepth(2), strip, strip, left, right, noise, uniformDepth(-1),
          uniformDepth(infinite), uniformDepth(1e9F), uniformDepth(1e-9F), room.depth, room.depth}) {
        RgbdFrame frame = room;
        frame.depth = depth;
        frame.timestamp = time += 1 / kRate;
        const MethodFrame result = method->processFrame(frame);
        ASSERT_TRUE(result.T_world_camera);
        EXPECT_TRUE(result.T_world_camera->matrix().allFinite());
        EXPECT_NE(result.tracked, !result.reason.empty()) << result.reason;
        EXPECT_NEAR(result.T_world_camera->linear().determinant(), 1, 1e-9);
    }
    EXPECT_EQ(method->processFrame(room).tracked, false) << "an old stamp";
}

TEST_P(Baselines, RefuseACameraThatCannotBe) {
    PinholeCamera camera = plainCamera();
    camera.fx = 0;
    EXPECT_THROW(make(camera), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(, Baselines,
                         ::testing::Values(Baseline{"difodo-240", 0.022, 0.12, 1e-5},
                                           Baseline{"icp-frame", 0.018, 0.15, 0.006},
                                           Baseline{"icp-keyframe", 0.010, 0.15, 0.001},
                                           Baseline{"opencv-rgbd", 0.055, 0.22, 1e-6},
                                           Baseline{"opencv-rgbd-icp", 0.0015, 0.005, 1e-6}),
                         [](const auto& info) {
                             std::string name = info.param.name;
                             for (char& c : name)
                                 if (c == '-') c = '_';
                             return name;
                         });

TEST(BaselineList, EveryOneSaysWhatItIs) {
    for (const char* name :
         {"difodo-240", "difodo-480", "icp-frame", "icp-keyframe", "opencv-rgbd", "opencv-rgbd-icp"}) {
        int found = 0;
        for (const MethodInfo& info : knownMethods()) {
            if (info.name != name) continue;
            ++found;
            EXPECT_FALSE(info.label.empty());
            EXPECT_FALSE(info.note.empty());
            EXPECT_FALSE(info.mode.has_value());
            EXPECT_EQ(info.note.find("weak") == 0, info.name.find("icp-") == 0) << name;
            if (!info.unavailable.empty()) {
                EXPECT_THROW(makeMethod(name, plainCamera(), OdometryOptions()), std::invalid_argument);
            }
        }
        EXPECT_EQ(found, 1) << name;
    }
}

}  // namespace
}  // namespace roevo
