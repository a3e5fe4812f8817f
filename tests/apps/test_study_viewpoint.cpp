// Repeatability under a change of viewpoint that is known exactly, in a simulated room.
#include <gtest/gtest.h>

#include "apps/study_fixture.h"
#include "repeatability/measure.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using StudyViewpoint = test::StudyFolder;

/// Ten frames a second: three times the motion between frames that a camera of thirty sees.
testing::Sequence fastRoom(int frames) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    options.fps = 10;
    return testing::simulate(options, frames);
}

// Measured beyond 35 degrees: optical flow 0.54, nearest neighbour 0.68, normals 0.72, disjoint set 0.81.
TEST_F(StudyViewpoint, OrderOfThePaperInASimulatedRoom) {
    const testing::Sequence sequence = fastRoom(40);
    const Repeatability measured = measureRepeatability(input("room", sequence, true), {40, 40});
    ASSERT_EQ(measured.rows.size(), 39U);
    EXPECT_EQ(measured.searched_by, "ground truth");
    EXPECT_LT(measured.disagreement, 0.5) << "px: the odometry must be right here";
    constexpr double kLargeChange = 35;  // deg
    std::array<double, kNumAssociationMethods> sum{};
    double count = 0;
    for (const RepeatabilityRow& row : measured.rows) {
        const Pose change =
            sequence.truth[row.frame].T_world_camera.inverse() * sequence.truth[row.reference].T_world_camera;
        EXPECT_NEAR(row.rotation_deg, rotationAngle(change) / kDegree, 1e-6);
        EXPECT_NEAR(row.translation, change.translation().norm(), 1e-9);
        if (row.rotation_deg < kLargeChange) continue;
        ++count;
        for (std::size_t m = 0; m < kNumAssociationMethods; ++m) sum[m] += row.share[m].value();
    }
    ASSERT_GT(count, 8);
    const auto mean = [&](AssociationMethod method) { return sum[static_cast<std::size_t>(method)] / count; };
    EXPECT_GT(mean(AssociationMethod::kDisjointSet), mean(AssociationMethod::kNormals) + 0.05);
    EXPECT_GT(mean(AssociationMethod::kNormals), mean(AssociationMethod::kNearest) + 0.02);
    EXPECT_GT(mean(AssociationMethod::kDisjointSet), mean(AssociationMethod::kOpticalFlow) + 0.2);
}

}  // namespace
}  // namespace roevo
