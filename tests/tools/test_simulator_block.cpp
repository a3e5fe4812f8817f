// The scene block and the path loop: back to the start, through no wall; repeated places look alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "simulator_check.h"

namespace roevo::simulator {
namespace {

SimulationOptions loopOptions() {
    SimulationOptions options = smallOptions("block");
    options.path = PathKind::kLoop;
    return options;
}

/// Distance to the box around a primitive, which is never more than that to its surface.
double distanceToBounds(const Primitive& primitive, const Eigen::Vector3d& world) {
    const double wide = std::max(1., primitive.taper), thick = primitive.shape == Shape::kQuad ? 0 : 1;
    const Eigen::Vector3d half = primitive.half_size.cwiseProduct(Eigen::Vector3d(wide, wide, thick));
    const Eigen::Vector3d local = primitive.R_world_object.transpose() * (world - primitive.centre);
    return (local.cwiseAbs() - half).cwiseMax(0).norm();
}

TEST(BlockLoop, ComesBackToItsStart) {
    SimulationOptions options = loopOptions();
    for (const double speed : {0.45, 1.2}) {
        options.speed = speed;
        const Simulator simulator(options);
        const double circuit = simulator.circuitTime();
        for (const double seconds : {0., 2., 5.}) {
            const Pose first = simulator.poseAt(seconds), again = simulator.poseAt(circuit + seconds);
            EXPECT_LT((again.translation() - first.translation()).norm(), 0.03);  // the tremor differs
            EXPECT_LT(Eigen::AngleAxisd(first.linear().transpose() * again.linear()).angle(), 0.04);
        }
        double length = 0, farthest = 0;
        const Eigen::Vector3d start = simulator.poseAt(0).translation();
        for (double t = 0; t < circuit; t += 0.5) {
            const Eigen::Vector3d here = simulator.poseAt(t).translation();
            length += (simulator.poseAt(std::min(t + 0.5, circuit)).translation() - here).norm();
            farthest = std::max(farthest, (here - start).norm());
        }
        EXPECT_GT(length, 60.0);
        EXPECT_GT(farthest, 18.0);
    }
}

TEST(BlockLoop, TakesAsManyFramesAsTheHelpSays) {
    SimulationOptions options = loopOptions();
    EXPECT_NEAR(Simulator(options).circuitTime() * 30, 4255, 3);
    options.speed = 1.2;
    EXPECT_NEAR(Simulator(options).circuitTime() * 30, 2003, 3);
}

TEST(BlockLoop, KeepsClearOfEverySurface) {
    for (const PathKind path : {PathKind::kLoop, PathKind::kWalk, PathKind::kHandheld}) {
        SimulationOptions options = loopOptions();
        options.path = path;
        const Simulator simulator(options);
        double nearest = 1e9;
        for (double t = 0; t < simulator.circuitTime(); t += 0.1) {
            const Eigen::Vector3d eye = simulator.poseAt(t).translation();
            for (const Primitive& primitive : simulator.scene().primitives)
                nearest = std::min(nearest, distanceToBounds(primitive, eye));
        }
        EXPECT_GT(nearest, 0.35);
        EXPECT_LT(nearest, 1.0) << "a corridor is narrow";
    }
}

/// Views at equal distances along the circuit: view i of the first half is where view i of the second would
/// be if the block were turned by half a turn.
class BlockViews : public testing::Test {
  protected:
    static constexpr int kHalf = 24;

    static void SetUpTestSuite() {
        SimulationOptions options = loopOptions();
        options.fps = 2 * kHalf / Simulator(options).circuitTime();
        options.frames = 2 * kHalf;
        const Simulator simulator(options);
        for (int i = 0; i < 2 * kHalf; ++i) {
            views_.push_back(simulator.frame(i));
            smooth_.emplace_back();
            cv::GaussianBlur(views_.back().grey, smooth_.back(), {}, 2.5);
        }
    }
    static void TearDownTestSuite() {
        views_.clear();
        smooth_.clear();
    }

    static const SimulatedFrame& view(int i) { return views_[static_cast<size_t>(i)]; }

    /// Mean difference of two views, grey levels, but for what the tremor moves by a pixel or two.
    static double difference(int a, int b) {
        cv::Mat levels;
        cv::absdiff(smooth_[static_cast<size_t>(a)], smooth_[static_cast<size_t>(b)], levels);
        return cv::mean(levels)[0];
    }
    /// The difference from the view that is most like view i, but for i itself and `twin`.
    static double differenceOfOthers(int i, int twin) {
        double least = 1e9;
        for (int other = 0; other < 2 * kHalf; ++other)
            if (other != i && other != twin) least = std::min(least, difference(i, other));
        return least;
    }
    static double medianDepthDifference(int a, int b) {
        cv::Mat metres;
        cv::absdiff(view(a).depth, view(b).depth, metres);
        std::vector<float> sorted(metres.begin<float>(), metres.end<float>());
        std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
        return sorted[sorted.size() / 2];
    }

    static inline std::vector<SimulatedFrame> views_;
    static inline std::vector<cv::Mat> smooth_;
};

TEST_F(BlockViews, RepeatedPlacesLookAlikeAndUniqueOnesDoNot) {
    // Along the south corridor, past its office (view 1), and out of the east corridor: as half-way round.
    for (const int i : {0, 1, 2, 3, 4, 5, 6, 21, 22, 23}) {
        const int twin = i + kHalf;
        EXPECT_GT((view(i).T_world_camera.translation() - view(twin).T_world_camera.translation()).norm(),
                  10);
        EXPECT_LT(difference(i, twin), 5.5) << "view " << i;
        EXPECT_GT(differenceOfOthers(i, twin), 1.5 * difference(i, twin)) << "view " << i;
    }
    // The south corridor's last bay and corner, then the east corridor to its end: as nowhere else.
    for (const int i : {7, 8, 9, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20})
        EXPECT_GT(differenceOfOthers(i, i), 6.5) << "view " << i;
    // East and west corridor have niches at the same place, but are made of other materials.
    for (const int i : {11, 12, 13, 14, 15, 16, 17})
        EXPECT_LT(medianDepthDifference(i, i + kHalf), 0.06) << "view " << i;
}

TEST_F(BlockViews, EdgesAreSeenEverywhere) {
    for (int i = 0; i < 2 * kHalf; ++i) {
        cv::Mat dx, dy, magnitude;
        cv::Sobel(view(i).grey, dx, CV_32F, 1, 0, 3, 0.125);
        cv::Sobel(view(i).grey, dy, CV_32F, 0, 1, 3, 0.125);
        cv::magnitude(dx, dy, magnitude);
        EXPECT_GT(cv::countNonZero(magnitude > 6), 0.12 * static_cast<double>(view(i).grey.total()))
            << "view " << i;
    }
}

TEST(BlockLoop, IsRefusedWhereThereIsNoWayRound) {
    for (const std::string& scene : sceneNames()) {
        SimulationOptions options = smallOptions(scene);
        options.path = PathKind::kLoop;
        if (!makeScene(scene).round_loop.empty()) {
            EXPECT_NO_THROW(Simulator{options}) << scene;
            continue;
        }
        try {
            const Simulator simulator(options);
            ADD_FAILURE() << scene << " has no loop";
        } catch (const std::runtime_error& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find("'" + scene + "' has no path 'loop'"), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos);
        }
    }
    EXPECT_EQ(pathKindFromName("loop"), PathKind::kLoop);
}

}  // namespace
}  // namespace roevo::simulator
