// Every option at both ends of its range, alone, on a real clip: an honest result, or a refusal that names
// it.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/support/real_clip.h"
#include "roevo/odometry.h"

namespace roevo {
namespace {

std::vector<std::string> optionNames() {
    OdometryOptions options;
    std::vector<std::string> names;
    for (const OptionField& field : optionFields(options)) names.push_back(field.name());
    return names;
}

/// The ends of an option's range, as text.
std::vector<std::string> endsOf(const OptionField& field) {
    if (std::holds_alternative<bool*>(field.value)) return {"false", "true"};
    if (std::holds_alternative<Mode*>(field.value)) return {"ct", "tr", "ba"};
    std::vector<std::string> ends;
    for (const double end : {field.min, field.max}) {
        OdometryOptions options;
        for (OptionField& own : optionFields(options)) {
            if (own.name() != field.name()) continue;
            if (auto* number = std::get_if<double*>(&own.value)) **number = end;
            if (auto* whole = std::get_if<int*>(&own.value)) **whole = static_cast<int>(end);
            ends.push_back(own.toText());
        }
    }
    return ends;
}

void expectRigid(const Pose& pose) {
    ASSERT_TRUE(pose.isFinite());
    EXPECT_LT((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
}

void expectHonest(const PinholeCamera& camera, const std::vector<RgbdFrame>& frames,
                  const OdometryOptions& options) {
    Odometry odometry(camera, options);
    std::size_t with_pose = 0;
    for (const RgbdFrame& frame : frames) {
        const FrameResult result = odometry.processFrame(frame);
        if (result.status != FrameStatus::kOk) {
            EXPECT_NE(result.reason, "");
        }
        with_pose += result.hasPose();
        expectRigid(result.T_world_camera);
        EXPECT_TRUE(result.covariance.allFinite());
    }
    const auto trajectory = odometry.trajectory();
    EXPECT_EQ(trajectory.size(), with_pose);
    for (const StampedPose& pose : trajectory) expectRigid(pose.T_world_camera);
    for (const KeyframeInfo& keyframe : odometry.keyframes()) expectRigid(keyframe.T_world_camera);
    for (const MapEdge& edge : odometry.map())
        for (const auto& point : edge.points) ASSERT_TRUE(point.allFinite());
}

class OptionExtremes : public ::testing::TestWithParam<std::string> {};

// Poses of a chain of keyframes stopped being rigid when nearly every frame became one
// (keyframe.max_translation at its least), with exit code 0 and quaternions of length 1e68.
TEST_P(OptionExtremes, GiveRigidPosesOrAnHonestLoss) {
    constexpr std::size_t kFrames = 60;
    const auto clip = testing::realClip("tum_fr1_xyz_150", kFrames);
    if (!clip) GTEST_SKIP() << "no clip tum_fr1_xyz_150";
    OdometryOptions defaults;
    for (const OptionField& field : optionFields(defaults)) {
        if (field.name() != GetParam()) continue;
        for (const std::string& end : endsOf(field)) {
            SCOPED_TRACE(GetParam() + " = " + end);
            OdometryOptions options;
            ASSERT_EQ(setOption(options, GetParam(), end), "");
            if (const std::string fault = checkOptions(options); !fault.empty()) {
                EXPECT_NE(fault.find(field.section + "."), std::string::npos) << fault;
                EXPECT_THROW(Odometry(clip->camera, options), std::invalid_argument);
                continue;
            }
            expectHonest(clip->camera, clip->frames, options);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Each, OptionExtremes, ::testing::ValuesIn(optionNames()), [](const auto& info) {
    std::string name = info.param;
    for (char& c : name)
        if (c == '.') c = '_';
    return name;
});

}  // namespace
}  // namespace roevo
