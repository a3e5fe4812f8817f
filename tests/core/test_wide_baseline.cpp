// Views of real clips that are far apart: sparse keyframes, fast turns, frames that are missing. Skips,
// visibly, without the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "core/support/real_clip.h"
#include "evaluation/evaluate.h"
#include "roevo/odometry.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

struct Walk {
    std::size_t start;
    double depth_noise;  ///< 1/m
};

// 0.67 s and up to 23 cm between frames: tracking fails now and then, and what a search finds is the right
// pose, known to a few centimetres. While it had to be known to 2 cm, starts 1, 2, 3 and 10 ended 10 to 19 cm
// off. The newest keyframe may show half of what the frame after it shows: with depth noise that is 2 % less
// or more, which moves everything a little, three walks ended 14 to 17 cm off before frames were tracked from
// the keyframe before it, too.
class WideBaseline : public ::testing::TestWithParam<Walk> {};

TEST_P(WideBaseline, TheWayAroundTheCabinetIsFound) {
    constexpr std::size_t kAll = 58;
    const auto clip = testing::realClip("tum_fr3_cabinet_loop_58", kAll);
    if (!clip) GTEST_SKIP() << "no clip tum_fr3_cabinet_loop_58";
    OdometryOptions options;
    options.sensor.depth_noise = GetParam().depth_noise;
    Odometry odometry(clip->camera, options);
    for (std::size_t i = GetParam().start; i < clip->frames.size(); ++i)
        (void)odometry.processFrame(clip->frames[i]);
    (void)odometry.refineAll();
    const double rmse = evaluate(clip->truth, odometry.trajectory()).ate.translation.rmse;
    RecordProperty("ba_cm", std::to_string(100 * rmse));
    EXPECT_LE(rmse, 0.05);
}
INSTANTIATE_TEST_SUITE_P(Starts, WideBaseline,
                         ::testing::Values(Walk{0, 0.002}, Walk{1, 0.002}, Walk{2, 0.002}, Walk{3, 0.002},
                                           Walk{10, 0.002}, Walk{5, 0.00205}, Walk{14, 0.00205},
                                           Walk{1, 0.00195}),
                         [](const auto& info) {
                             return "From" + std::to_string(info.param.start) + "_noise_" +
                                    std::to_string(std::lround(1e5 * info.param.depth_noise));
                         });

// Every tenth frame, backwards: up to 35 degrees between two. One was taken for another view without a word,
// by 36 % of its edges, 50 cm and 35 degrees off; a search matches 64 %.
TEST(WideTurns, APoseThatFewEdgesMatchIsNotTheLastWord) {
    const auto clip = testing::realClip("tum_fr1_rpy_100", 100);
    if (!clip) GTEST_SKIP() << "no clip tum_fr1_rpy_100";
    const testing::RealFrames backwards = testing::reversed(*clip);
    for (const double depth_weight : {0.4, 0.41}) {
        OdometryOptions options;
        options.fine.depth_weight = depth_weight;
        Odometry odometry(clip->camera, options);
        for (std::size_t i = 9; i < backwards.frames.size(); i += 10)
            (void)odometry.processFrame(backwards.frames[i]);
        const double rmse = evaluate(backwards.truth, odometry.trajectory()).ate.translation.rmse;
        EXPECT_LE(rmse, 0.04) << "depth weight " << depth_weight;
    }
}

// Ten frames in a row, then one that comes 12 to 30 frames later. Before the last of the ten took over as the
// keyframe, and the late one was tracked back to it, 6, 9, 8 and 3 were lost.
struct Jump {
    const char* name;
    std::size_t before, missing, every;
    int most_lost, least_right;
};

std::ostream& operator<<(std::ostream& out, const Jump& jump) {
    return out << jump.missing << " frames of " << jump.name;
}

class Jumps : public ::testing::TestWithParam<Jump> {};

Pose truthAt(const std::vector<StampedPose>& truth, double time) {
    return std::min_element(truth.begin(), truth.end(),
                            [&](const StampedPose& a, const StampedPose& b) {
                                return std::abs(a.timestamp - time) < std::abs(b.timestamp - time);
                            })
        ->T_world_camera;
}

TEST_P(Jumps, AreFollowedFromTheFrameBefore) {
    const Jump& jump = GetParam();
    const auto clip = testing::realClip(jump.name, 150);
    if (!clip) GTEST_SKIP() << "no clip " << jump.name;
    OdometryOptions options;
    options.mode = Mode::kTracking;
    int lost = 0, right = 0;
    for (const testing::RealFrames& way : {*clip, testing::reversed(*clip)}) {
        for (std::size_t start = 0; start + jump.before - 1 + jump.missing < way.frames.size();
             start += jump.every) {
            Odometry odometry(way.camera, options, truthAt(way.truth, way.frames[start].timestamp));
            for (std::size_t i = 0; i < jump.before; ++i) (void)odometry.processFrame(way.frames[start + i]);
            const RgbdFrame& late = way.frames[start + jump.before - 1 + jump.missing];
            const FrameResult result = odometry.processFrame(late);
            const Pose error = result.T_world_camera.inverse() * truthAt(way.truth, late.timestamp);
            lost += result.status == FrameStatus::kOk ? 0 : 1;
            right += result.status == FrameStatus::kOk && error.translation().norm() < 0.05 &&
                             rotationAngle(error) < 2 * kDegree
                         ? 1
                         : 0;
        }
    }
    RecordProperty("lost", lost);
    RecordProperty("right", right);
    EXPECT_LE(lost, jump.most_lost);
    EXPECT_GE(right, jump.least_right);
}

INSTANTIATE_TEST_SUITE_P(Clips, Jumps,
                         ::testing::Values(Jump{"tum_fr1_rpy_100", 10, 12, 6, 3, 19},
                                           Jump{"tum_fr1_rpy_100", 10, 16, 6, 5, 14},
                                           Jump{"tum_fr1_xyz_150", 10, 30, 6, 5, 33},
                                           Jump{"tum_fr3_cabinet_loop_58", 3, 2, 3, 1, 23}),
                         [](const auto& info) {
                             return std::string(info.param.name) + "_" + std::to_string(info.param.missing);
                         });

}  // namespace
}  // namespace roevo
