// Longer simulated sequences at full size: the accuracy that is promised.
#include <gtest/gtest.h>

#include "core/support/simulated.h"

namespace roevo {
namespace {

constexpr int kFrames = 120;

void expectAccurate(const simulator::SimulationOptions& options, double limit) {
    const testing::Sequence sequence = testing::simulate(options, kFrames);
    ASSERT_GT(pathLength(sequence.truth), 1.0);
    const testing::TrackedRun run = testing::track(sequence);
    EXPECT_EQ(run.results.front().status, FrameStatus::kInitialised);
    EXPECT_EQ(run.count(FrameStatus::kOk), kFrames - 1);
    const double ate = evaluate(sequence.truth, run.trajectory).ate.translation.rmse;
    ::testing::Test::RecordProperty("ate_mm", std::to_string(1000 * ate));
    EXPECT_LE(ate, limit);
}

TEST(SimulatedSequence, LivingroomWithoutNoise) {
    expectAccurate({}, 0.003);
}

TEST(SimulatedSequence, LivingroomWithTheNoiseOfAKinect) {
    simulator::SimulationOptions options;
    options.useKinectNoise();
    expectAccurate(options, 0.010);
}

TEST(SimulatedSequence, CorridorWithNoise) {
    simulator::SimulationOptions options;
    options.scene = "corridor";
    options.useKinectNoise();
    expectAccurate(options, 0.020);
}

}  // namespace
}  // namespace roevo
