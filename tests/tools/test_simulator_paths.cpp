// Camera paths: smooth, long enough, within the limits of a hand, clear of the furniture.
#include <gtest/gtest.h>

#include <algorithm>

#include "simulator_check.h"

namespace roevo::simulator {
namespace {

constexpr double kDegree = 3.14159265358979 / 180;

double pathLength(const Simulator& simulator, double seconds) {
    double length = 0;
    for (int i = 0; i < static_cast<int>(seconds * 30); ++i)
        length +=
            (simulator.poseAt((i + 1) / 30.).translation() - simulator.poseAt(i / 30.).translation()).norm();
    return length;
}

class EveryPath : public testing::TestWithParam<std::tuple<std::string, PathKind>> {
  protected:
    Simulator make(int frames) const {
        SimulationOptions options = smallOptions(std::get<0>(GetParam()), frames);
        options.path = std::get<1>(GetParam());
        options.width = 64, options.height = 48;
        return Simulator(options);
    }
};

TEST_P(EveryPath, IsSmoothAndWithinItsLimits) {
    const Simulator simulator = make(3000);
    const double h = 0.01;
    double fastest = 0, fastest_turn = 0, hardest_jerk = 0;
    Pose before = simulator.poseAt(0), here = simulator.poseAt(h);
    Eigen::Vector3d acceleration_before = Eigen::Vector3d::Zero();
    for (int i = 2; i < 10000; ++i) {
        const Pose next = simulator.poseAt(i * h);
        fastest = std::max(fastest, (next.translation() - here.translation()).norm() / h);
        fastest_turn =
            std::max(fastest_turn, Eigen::AngleAxisd(here.linear().transpose() * next.linear()).angle() / h);
        const Eigen::Vector3d acceleration =
            (next.translation() - 2 * here.translation() + before.translation()) / (h * h);
        if (i > 2) hardest_jerk = std::max(hardest_jerk, (acceleration - acceleration_before).norm() / h);
        acceleration_before = acceleration;
        before = here;
        here = next;
    }
    EXPECT_LT(fastest, 0.55);               // m/s
    EXPECT_LT(fastest_turn, 25 * kDegree);  // rad/s
    EXPECT_LT(hardest_jerk, 15);            // m/s^3; a kink in the velocity of 0.01 m/s would give 100
}

TEST_P(EveryPath, KeepsItsDistanceAndLooksAtSomething) {
    const Simulator simulator = make(3000);
    for (int index = 0; index < 3000; index += 60) {
        const SimulatedFrame frame = simulator.frame(index);
        std::vector<float> depths(frame.depth.begin<float>(), frame.depth.end<float>());
        std::sort(depths.begin(), depths.end());
        std::vector<int> objects(frame.objects.begin<int>(), frame.objects.end<int>());
        std::sort(objects.begin(), objects.end());
        const auto kinds = std::unique(objects.begin(), objects.end()) - objects.begin();
        EXPECT_GT(depths.front(), 0.3) << "frame " << index;
        EXPECT_GT(depths[depths.size() / 2], 0.8) << "frame " << index;
        EXPECT_LT(depths[depths.size() / 2], 4.5) << "frame " << index;
        EXPECT_GE(kinds, 6) << "frame " << index;
    }
}

INSTANTIATE_TEST_SUITE_P(Paths, EveryPath,
                         testing::Combine(testing::ValuesIn(sceneNames()),
                                          testing::Values(PathKind::kHandheld, PathKind::kWalk,
                                                          PathKind::kBackAndForth)));
INSTANTIATE_TEST_SUITE_P(RoundTheBlock, EveryPath,
                         testing::Values(std::tuple(std::string("block"), PathKind::kLoop)));

TEST(CameraPaths, DefaultLivingroomPathIsSeveralMetresLong) {
    const Simulator simulator(smallOptions("livingroom"));
    EXPECT_GE(pathLength(simulator, 10), 3.5);
    EXPECT_LE(pathLength(simulator, 10), 5.5);
}

TEST(CameraPaths, WalksAreLong) {
    for (const std::string scene : {"livingroom", "corridor", "block"}) {
        SimulationOptions options = smallOptions(scene, 3000);
        options.path = PathKind::kWalk;
        EXPECT_GE(pathLength(Simulator(options), 100), 30.0) << scene;
    }
}

TEST(CameraPaths, BackAndForthReturnsSixTimesAMinute) {
    SimulationOptions options = smallOptions("livingroom", 1800);
    options.path = PathKind::kBackAndForth;
    const Simulator simulator(options);
    const Eigen::Vector3d start = simulator.poseAt(0).translation();
    for (int i = 1; i <= 6; ++i) {
        EXPECT_LT((simulator.poseAt(10 * i).translation() - start).norm(), 0.03);  // the tremor differs
        EXPECT_GT((simulator.poseAt(10 * i - 5).translation() - start).norm(), 0.6);
    }
}

TEST(CameraPaths, FrameStampsAndPosesBelongTogether) {
    SimulationOptions options = smallOptions("shadows", 10);
    options.fps = 20;
    options.start_time = 100;
    const Simulator simulator(options);
    EXPECT_DOUBLE_EQ(simulator.timestamp(4), 100.2);
    EXPECT_EQ(simulator.frame(4).T_world_camera.matrix(), simulator.poseAt(0.2).matrix());
}

}  // namespace
}  // namespace roevo::simulator
