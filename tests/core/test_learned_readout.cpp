// The read-out time of a rolling shutter is learned from the images, and soon enough to be of use.
#include <gtest/gtest.h>

#include <sstream>

#include "core/support/simulated.h"

namespace roevo {
namespace {

constexpr int kFrames = 40;
constexpr double kReadout = 0.02;  // s

simulator::SimulationOptions rolling(double readout, const std::string& scene) {
    simulator::SimulationOptions options;
    options.scene = scene;
    options.useKinectNoise();
    options.rolling_shutter = readout;
    return options;
}

struct Learned {
    double readout = 0;  // s
    double ate = 0;      // m
};

Learned learn(const testing::Sequence& sequence, const OdometryOptions& options) {
    Odometry odometry(sequence.camera, options, sequence.start());
    Learned learned;
    for (const RgbdFrame& frame : sequence.frames) (void)odometry.processFrame(frame);
    learned.readout = odometry.readoutTime();
    learned.ate = evaluate(sequence.truth, odometry.trajectory()).ate.translation.rmse;
    return learned;
}

class LearnedReadout : public ::testing::TestWithParam<std::string> {};

TEST_P(LearnedReadout, IsNearlyRightAfterFortyFramesAndHelps) {
    const testing::Sequence sequence = testing::simulate(rolling(kReadout, GetParam()), kFrames);
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        OdometryOptions options;
        options.mode = mode;
        const Learned learned = learn(sequence, options);
        // Of a track's first frame no motion is known. Taken for still, it teaches that there is none.
        EXPECT_NEAR(learned.readout, kReadout, 0.005);
        options.sensor.estimate_readout = false;
        const Learned global = learn(sequence, options);
        options.sensor.readout_time = kReadout;
        const Learned known = learn(sequence, options);
        EXPECT_LT(learned.ate, 0.8 * global.ate);
        EXPECT_LT(learned.ate, known.ate + 0.0003);
        EXPECT_LT(known.ate, 0.75 * global.ate);
        RecordProperty("mm", std::to_string(1000 * learned.ate) + " of " + std::to_string(1000 * global.ate) +
                                 ", known " + std::to_string(1000 * known.ate));
    }
}

TEST_P(LearnedReadout, IsNoneWhereAllRowsAreReadAtOnce) {
    const testing::Sequence sequence = testing::simulate(rolling(0, GetParam()), kFrames);
    EXPECT_NEAR(learn(sequence, OdometryOptions()).readout, 0, 0.002);
}

TEST_P(LearnedReadout, IsKeptInAMap) {
    const testing::Sequence sequence = testing::simulate(rolling(kReadout, GetParam()), kFrames);
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        OdometryOptions options;
        options.mode = mode;
        options.keyframe.max_translation = 0.03;
        Odometry odometry(sequence.camera, options);
        for (const RgbdFrame& frame : sequence.frames) (void)odometry.processFrame(frame);
        std::ostringstream map;
        (void)odometry.saveMap(map);
        Odometry later(sequence.camera, options);
        EXPECT_EQ(later.readoutTime(), 0);
        std::istringstream in(map.str());
        (void)later.loadMap(in);
        EXPECT_NEAR(later.readoutTime(), kReadout, 0.006) << "known before the first frame";
    }
}

// Where a camera was in a gap, and how fast, nobody knows: the mean velocity of the gap, taken for that of
// the rows at its end, taught that they were all read at once.
TEST(LearnedReadoutBesideGaps, IsNotUnlearned) {
    simulator::SimulationOptions simulation = testing::smallRoom();
    simulation.rolling_shutter = kReadout;
    const testing::Sequence sequence = testing::simulate(simulation, 50);
    // Again and again the camera goes back while nobody looks, and six frames come once more
    testing::Sequence jumping;
    jumping.camera = sequence.camera;
    constexpr std::size_t kTogether = 12, kBack = 6;
    constexpr double kGap = 0.3;  // s
    double late = 0;
    for (std::size_t first = 0; first + kTogether <= sequence.frames.size(); first += kTogether - kBack) {
        for (std::size_t i = first; i < first + kTogether; ++i) {
            jumping.frames.push_back(sequence.frames[i]);
            jumping.truth.push_back(sequence.truth[i]);
            jumping.frames.back().timestamp += late;
            jumping.truth.back().timestamp += late;
        }
        late += kGap;
    }
    OdometryOptions options;
    options.sensor.readout_sigma = 0.1;     // so that the few frames decide
    options.keyframe.max_rotation_deg = 2;  // so that keyframes begin at the end of gaps
    EXPECT_NEAR(learn(jumping, options).readout, kReadout, 0.007);
}

INSTANTIATE_TEST_SUITE_P(Scenes, LearnedReadout, ::testing::Values("livingroom", "corridor"),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace roevo
