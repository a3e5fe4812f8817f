// Mode ba on input and options that give the mapper little or nothing: the run goes on and says why.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "core/support/mapped_run.h"

namespace roevo {
namespace {

using namespace testing;

class MappingBadInput : public ::testing::Test {
  protected:
    void start(const OdometryOptions& options) {
        options_ = options;
        has_last_ = false;
        time_ = 0;
        with_pose_ = updates_ = 0;
        map_reasons_.clear();
        odometry_ = std::make_unique<Odometry>(room().camera, options, room().start());
    }
    /// Processes a frame one interval after the last one; poses stay finite and no jump goes unreported.
    FrameResult feed(RgbdFrame frame) {
        frame.timestamp = (time_ += kInterval);
        const FrameResult result = odometry_->processFrame(frame);
        EXPECT_EQ(result.reason.find('\n'), std::string::npos);
        if (result.status != FrameStatus::kOk) {
            EXPECT_NE(result.reason, "");
        }
        EXPECT_TRUE(result.T_world_camera.isFinite());
        EXPECT_TRUE(result.covariance.allFinite());
        if (!result.hasPose()) return result;
        if (has_last_) {
            const double step = distance(last_, result.T_world_camera) - result.map_correction;
            EXPECT_LT(step, kLargestStep)
                << "at " << time_ << " " << toString(result.status) << " " << result.reason;
        }
        last_ = result.T_world_camera;
        has_last_ = true;
        ++with_pose_;
        if (result.map_correction > kMoved) ++updates_;
        for (const MapRefusal& refusal : result.map_refusals) {
            map_reasons_.push_back(describe(refusal));
            EXPECT_EQ(map_reasons_.back().find('\n'), std::string::npos);
        }
        return result;
    }
    void feedRoom(int first, int end) {
        for (int i = first; i < end; ++i) {
            const FrameResult result = feed(roomFrame(i));
            EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk)
                << i << " " << result.reason;
        }
    }
    static const RgbdFrame& roomFrame(int i) { return room().frames[static_cast<std::size_t>(i)]; }
    static RgbdFrame withDepth(const RgbdFrame& frame, float depth) {
        RgbdFrame changed = frame;
        changed.depth = cv::Mat(frame.grey.size(), CV_32FC1, cv::Scalar(static_cast<double>(depth)));
        return changed;
    }
    double errorAt(int i) const {
        return distance(last_, room().truth[static_cast<std::size_t>(i)].T_world_camera);
    }
    /// What holds at the end of any run.
    void expectSound() const {
        const auto trajectory = odometry_->trajectory(), live = odometry_->liveTrajectory();
        EXPECT_EQ(trajectory.size(), static_cast<std::size_t>(with_pose_));
        ASSERT_EQ(live.size(), trajectory.size());
        for (std::size_t i = 0; i < trajectory.size(); ++i) {
            EXPECT_EQ(trajectory[i].timestamp, live[i].timestamp);
            EXPECT_TRUE(trajectory[i].T_world_camera.isFinite());
            if (i > 0) {
                EXPECT_GT(trajectory[i].timestamp, trajectory[i - 1].timestamp);
            }
        }
        const auto keyframes = odometry_->keyframes();
        for (std::size_t k = 0; k < keyframes.size(); ++k) {
            EXPECT_EQ(keyframes[k].id, static_cast<int>(k));
            EXPECT_TRUE(keyframes[k].T_world_camera.isFinite());
            if (k > 0) {
                EXPECT_GT(keyframes[k].timestamp, keyframes[k - 1].timestamp);
            }
        }
        for (const EdgeMap& map : {odometry_->map(), odometry_->keyframeEdges()}) {
            for (const MapEdge& edge : map) {
                EXPECT_LT(edge.keyframe_id, static_cast<int>(keyframes.size()));
                for (const auto& point : edge.points) ASSERT_TRUE(point.allFinite());
            }
        }
    }
    bool saidOfMapping(const std::string& words) const {
        return std::any_of(map_reasons_.begin(), map_reasons_.end(), [&](const std::string& reason) {
            return reason.find(words) != std::string::npos;
        });
    }

    /// m: twice what the simulated camera does within a frame (0.45 m/s), and a little for its errors.
    static constexpr double kLargestStep = 2 * 0.45 * kInterval + 0.005;
    OdometryOptions options_;
    std::unique_ptr<Odometry> odometry_;
    Pose last_ = Pose::Identity();
    bool has_last_ = false;
    double time_ = 0;
    int with_pose_ = 0, updates_ = 0;
    std::vector<std::string> map_reasons_;
};

TEST_F(MappingBadInput, AMapperThatGetsNoKeyframeForLongGoesOnAfterwards) {
    start(manyKeyframes());
    feedRoom(0, 1);
    for (int i = 0; i < 300; ++i) {
        const FrameResult still = feed(roomFrame(0));
        ASSERT_EQ(still.status, FrameStatus::kOk) << still.reason;
        EXPECT_FALSE(still.new_keyframe);
        EXPECT_EQ(still.ms.mapping > 0, i + 1 == options_.mapping.latency) << i;
        EXPECT_LT(errorAt(0), 2e-5);
    }
    EXPECT_EQ(odometry_->keyframes().size(), 1U);
    EXPECT_EQ(updates_, 0);
    feedRoom(1, kRendered);
    EXPECT_GE(updates_, 3);
    EXPECT_LT(errorAt(kRendered - 1), 0.006);
    expectSound();
}

TEST_F(MappingBadInput, AWindowOfOneKeyframeIsRefusedAndOneOfTwoWorks) {
    OdometryOptions options = manyKeyframes();
    for (const int few : {1, 0, -3}) {
        options.mapping.window = few;
        try {
            start(options);
            ADD_FAILURE() << few << " was taken";
        } catch (const std::invalid_argument& fault) {
            const std::string text = fault.what();
            for (const std::string& word : {std::string("mapping.window"), std::to_string(few)})
                EXPECT_NE(text.find(word), std::string::npos) << text;
        }
    }
    options.mapping.window = 2;
    for (const bool reuse : {true, false}) {
        options.mapping.reuse_keyframes = reuse;
        start(options);
        feedRoom(0, kRendered);
        EXPECT_GE(updates_, 3);
        EXPECT_TRUE(map_reasons_.empty());
        EXPECT_LT(errorAt(kRendered - 1), 0.006);
        expectSound();
    }
}

TEST_F(MappingBadInput, WhenAllEdgesAreRejectedTheKeyframesStayAsTrackedAndItIsSaid) {
    OdometryOptions options = manyKeyframes();
    options.mapping.max_spread = 0.01;  // no two observations agree so well
    options.motion.smooth = false;
    start(options);
    feedRoom(0, kRendered);
    EXPECT_GE(odometry_->keyframes().size(), 4U);
    EXPECT_TRUE(saidOfMapping("left as it was")) << map_reasons_.size();
    EXPECT_LT(errorAt(kRendered - 1), 0.006);
    expectSound();
    const auto final_poses = odometry_->trajectory(), live = odometry_->liveTrajectory();
    for (std::size_t i = 0; i < live.size(); ++i)
        EXPECT_LT(distance(final_poses[i].T_world_camera, live[i].T_world_camera), 1e-9) << i;
    int confirmed = 0, spread = 0;
    for (const MapEdge& edge : odometry_->map()) {
        confirmed += edge.verdict == EdgeVerdict::kTrue ? 1 : 0;
        spread += edge.verdict == EdgeVerdict::kSpread ? 1 : 0;
    }
    // Where edges are stitched end to end no point is seen twice, and there is no spread
    EXPECT_GT(spread, 100);
    EXPECT_LT(confirmed, spread / 20);
}

TEST_F(MappingBadInput, WhenEveryKeyframeMustSeeAnEdgeTheRunGoesOn) {
    OdometryOptions options = manyKeyframes();
    options.mapping.min_seen = 1;
    options.mapping.min_looks = 2;
    start(options);
    feedRoom(0, kRendered);
    int vanishing = 0;
    for (const MapEdge& edge : odometry_->map()) vanishing += edge.verdict == EdgeVerdict::kVanishing ? 1 : 0;
    EXPECT_GT(vanishing, 10);
    EXPECT_LT(errorAt(kRendered - 1), 0.006);
    expectSound();
}

TEST_F(MappingBadInput, FramesWithoutDepthAtTheStartAreRejectedAndTheFirstWithDepthBegins) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    start(manyKeyframes());
    for (const float depth : {0.0F, nan, -1.0F}) {
        const FrameResult blind = feed(withDepth(roomFrame(0), depth));
        EXPECT_EQ(blind.status, FrameStatus::kRejected);
        EXPECT_NE(blind.reason.find("depth"), std::string::npos) << blind.reason;
    }
    EXPECT_TRUE(odometry_->keyframes().empty());
    EXPECT_TRUE(odometry_->map().empty());
    feedRoom(0, kRendered);
    EXPECT_GE(updates_, 3);
    EXPECT_LT(errorAt(kRendered - 1), 0.006);
    expectSound();
}

TEST_F(MappingBadInput, WithoutDepthNoKeyframeIsMadeAndItIsSaidUntilDepthIsBack) {
    constexpr int kFrom = 8, kTo = 20;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    start(manyKeyframes());
    feedRoom(0, kFrom);
    int due = 0;
    for (int i = kFrom; i < kTo; ++i) {
        const FrameResult blind = feed(withDepth(roomFrame(i), i % 2 == 0 ? 0 : nan));
        EXPECT_EQ(blind.status, FrameStatus::kOk) << blind.reason;
        EXPECT_FALSE(blind.new_keyframe);
        due += blind.reason.find("a new keyframe is due") != std::string::npos ? 1 : 0;
    }
    EXPECT_GE(due, 5);
    const int before = updates_;
    feedRoom(kTo, kRendered);
    EXPECT_LT(errorAt(kRendered - 1), 0.01);
    EXPECT_GT(updates_, before);
    expectSound();
}

TEST_F(MappingBadInput, WithoutDepthUntilTheEndAllPosesAreThere) {
    start(manyKeyframes());
    feedRoom(0, 12);
    for (int i = 12; i < kRendered; ++i) feed(withDepth(roomFrame(i), 0));
    EXPECT_LT(errorAt(kRendered - 1), 0.01);
    EXPECT_EQ(with_pose_, kRendered);
    expectSound();
}

TEST_F(MappingBadInput, ARunMayEndOrBeReplacedWhileTheMapperWorks) {
    OdometryOptions options = manyKeyframes();
    options.mapping.latency = 100;
    Odometry odometry(room().camera, options, room().start());
    for (int run = 0; run < 3; ++run) {
        odometry = Odometry(room().camera, options, room().start());
        for (std::size_t i = 0; i < 12; ++i) (void)odometry.processFrame(room().frames[i]);
    }
    EXPECT_EQ(odometry.trajectory().size(), 12U);
}

/// Another place, that tracking cannot have come to.
const Sequence& elsewhere() {
    static const Sequence sequence = [] {
        auto options = smallRoom();
        options.scene = "corridor";
        return simulate(options, 18);
    }();
    return sequence;
}

TEST_F(MappingBadInput, ALossIsBridgedHeldAndReanchoredWithReasons) {
    constexpr int kDark = 30;
    start(manyKeyframes());
    feedRoom(0, 14);
    for (int i = 1; i <= kDark; ++i) {
        const FrameResult dark = feed(black(0));
        const bool bridged = i <= options_.loss.max_predicted;
        EXPECT_EQ(dark.status, bridged ? FrameStatus::kPredicted : FrameStatus::kLost) << i;
        EXPECT_NE(dark.reason.find(bridged ? "constant velocity" : "pose held"), std::string::npos);
        EXPECT_FALSE(dark.new_keyframe);
    }
    const std::size_t keyframes_before = odometry_->keyframes().size();
    const FrameResult again = feed(elsewhere().frames[0]);
    ASSERT_EQ(again.status, FrameStatus::kInitialised) << again.reason;
    EXPECT_NE(again.reason.find("re-anchored after 31 frames"), std::string::npos) << again.reason;
    EXPECT_TRUE(again.new_keyframe);
    for (std::size_t i = 1; i < elsewhere().frames.size(); ++i) {
        const FrameResult result = feed(elsewhere().frames[i]);
        EXPECT_EQ(result.status, FrameStatus::kOk) << result.reason;
    }
    EXPECT_GE(odometry_->keyframes().size(), keyframes_before + 3);
    expectSound();
    const auto trajectory = odometry_->trajectory();
    for (std::size_t i = 0; i < 14; ++i)
        EXPECT_LT(distance(trajectory[i].T_world_camera, room().truth[i].T_world_camera), 0.006) << i;
}

TEST_F(MappingBadInput, WhenTheOldPlaceHasLeftTheWindowMappingGoesOnElsewhere) {
    OdometryOptions options = manyKeyframes();
    options.mapping.window = 3;
    start(options);
    feedRoom(0, 14);
    for (int i = 0; i < 30; ++i) feed(black(0));
    const int before = updates_;
    const FrameResult again = feed(elsewhere().frames[0]);
    ASSERT_EQ(again.status, FrameStatus::kInitialised) << again.reason;
    const Pose T_there = again.T_world_camera * elsewhere().start().inverse();
    double worst = 0;
    for (std::size_t i = 1; i < elsewhere().frames.size(); ++i) {
        feed(elsewhere().frames[i]);
        worst = std::max(worst, distance(T_there * elsewhere().truth[i].T_world_camera, last_));
    }
    RecordProperty("worst_mm", std::to_string(1000 * worst));
    EXPECT_LT(worst, 0.006);
    EXPECT_GT(updates_, before);
    expectSound();
}

TEST_F(MappingBadInput, ALossRightAfterAKeyframeStillGetsItsMap) {
    start(manyKeyframes());
    int frame = 0;
    for (int keyframes = 0; keyframes < 3; ++frame) keyframes += feed(roomFrame(frame)).new_keyframe ? 1 : 0;
    const int before = updates_;
    for (int i = 1; i <= options_.loss.max_predicted; ++i) {
        const FrameResult dark = feed(black(0));
        EXPECT_EQ(dark.status, FrameStatus::kPredicted);
        EXPECT_EQ(dark.map_correction > kMoved, i == options_.mapping.latency) << i;
    }
    EXPECT_EQ(updates_, before + 1);
    expectSound();
}

}  // namespace
}  // namespace roevo
