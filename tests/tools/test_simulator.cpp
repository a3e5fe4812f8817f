// The ray caster: exact depth and poses, anti-aliasing, determinism.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulator_check.h"

namespace roevo::simulator {
namespace {

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Fractions of pixels with a Sobel gradient above 6 grey levels per pixel, at borders of objects and within
/// them.
struct EdgeShares {
    double structure = 0, texture = 0;
};

EdgeShares edgeShares(const SimulatedFrame& frame) {
    cv::Mat dx, dy, magnitude;
    cv::Sobel(frame.grey, dx, CV_32F, 1, 0, 3, 0.125);
    cv::Sobel(frame.grey, dy, CV_32F, 0, 1, 3, 0.125);
    cv::magnitude(dx, dy, magnitude);
    EdgeShares shares;
    for (int v = 2; v + 2 < frame.grey.rows; ++v)
        for (int u = 2; u + 2 < frame.grey.cols; ++u) {
            if (magnitude.at<float>(v, u) < 6) continue;
            bool border = false;
            for (int i = 0; i < 25; ++i)
                border = border ||
                         frame.objects.at<int>(v + i / 5 - 2, u + i % 5 - 2) != frame.objects.at<int>(v, u);
            (border ? shares.structure : shares.texture) += 1. / static_cast<double>(frame.grey.total());
        }
    return shares;
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, BackProjectedDepthLiesOnTheSurface) {
    const Simulator simulator(smallOptions(GetParam()));
    for (const int index : {0, 137}) {
        const SimulatedFrame frame = simulator.frame(index);
        int seen = 0;
        double worst = 0;
        for (int v = 0; v < frame.depth.rows; ++v)
            for (int u = 0; u < frame.depth.cols; ++u) {
                const int object = frame.objects.at<int>(v, u);
                if (object < 0) continue;
                const Eigen::Vector3d point =
                    simulator.camera().backProject(u, v, frame.depth.at<float>(v, u));
                worst = std::max(worst,
                                 distanceToSurface(simulator.scene().primitives[static_cast<size_t>(object)],
                                                   frame.T_world_camera * point));
                ++seen;
            }
        EXPECT_LT(worst, 1e-5);
        EXPECT_EQ(seen, 160 * 120) << "a closed room fills the picture";
    }
}

TEST_P(EveryScene, TwoFramesAgreeThroughTheirPoses) {
    const Simulator simulator(smallOptions(GetParam()));
    const SimulatedFrame a = simulator.frame(20), b = simulator.frame(28);
    const Pose T_b_a = b.T_world_camera.inverse() * a.T_world_camera;
    ASSERT_GT(T_b_a.translation().norm(), 0.02);
    int compared = 0;
    for (int v = 0; v < a.depth.rows; ++v)
        for (int u = 0; u < a.depth.cols; ++u) {
            const int object = a.objects.at<int>(v, u);
            if (simulator.scene().primitives[static_cast<size_t>(object)].shape != Shape::kQuad) continue;
            const Eigen::Vector3d point =
                T_b_a * simulator.camera().backProject(u, v, a.depth.at<float>(v, u));
            const Eigen::Vector2d at = simulator.camera().project(point);
            const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
            if (x < 0 || y < 0 || x + 1 >= b.depth.cols || y + 1 >= b.depth.rows) continue;
            double inverse_depth = 0;  // of a plane this is linear in the image
            bool whole = true;
            for (int i = 0; i < 4; ++i) {
                const int col = x + i % 2, row = y + i / 2;
                whole = whole && b.objects.at<int>(row, col) == object;
                inverse_depth += (i % 2 ? at.x() - x : 1 - at.x() + x) *
                                 (i / 2 ? at.y() - y : 1 - at.y() + y) / b.depth.at<float>(row, col);
            }
            if (!whole) continue;
            ASSERT_NEAR(1 / inverse_depth, point.z(), 1e-5 * point.z());
            ++compared;
        }
    EXPECT_GT(compared, 2000);
}

TEST_P(EveryScene, SameBytesAtAnyThreadCountAndInAnyOrder) {
    SimulationOptions options = smallOptions(GetParam(), 40);
    options.useKinectNoise();
    options.rolling_shutter = 0.02;
    options.threads = 1;
    const Simulator one(options);
    options.threads = 3;
    const Simulator three(options);
    three.frame(30);
    const SimulatedFrame a = one.frame(7), b = three.frame(7);
    EXPECT_TRUE(sameBytes(a.colour, b.colour));
    EXPECT_TRUE(sameBytes(a.grey, b.grey));
    EXPECT_TRUE(sameBytes(a.depth, b.depth));
    EXPECT_TRUE(sameBytes(a.depth_noisy, b.depth_noisy));
    EXPECT_TRUE(sameBytes(a.shadow_border, b.shadow_border));
    EXPECT_EQ(a.T_world_camera.matrix(), b.T_world_camera.matrix());

    options.seed = 2;
    const SimulatedFrame other = Simulator(options).frame(7);
    EXPECT_FALSE(sameBytes(a.depth_noisy, other.depth_noisy));
    EXPECT_FALSE(sameBytes(a.colour, other.colour));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(sceneNames()));

TEST(Simulator, ScenesDifferInTextureAsPromised) {
    SimulationOptions options = smallOptions("livingroom");
    options.width = 320, options.height = 240;
    const EdgeShares livingroom = edgeShares(Simulator(options).frame(0));
    options.scene = "corridor";
    const EdgeShares corridor = edgeShares(Simulator(options).frame(0));
    options.scene = "shadows";
    const EdgeShares shadows = edgeShares(Simulator(options).frame(0));
    EXPECT_GT(livingroom.structure, 0.04);
    EXPECT_GT(livingroom.texture, 0.04);
    EXPECT_GT(corridor.structure, 0.03);
    EXPECT_LT(corridor.texture, 0.4 * livingroom.texture);  // what is left are edges between faces of one box
    EXPECT_GT(shadows.structure, 0.01);
    EXPECT_LT(shadows.texture, 0.25 * livingroom.texture);  // shadows themselves
}

TEST(Simulator, PicturesAreAntiAliased) {
    // Rendered large and shrunk is what a perfect box filter would give; aliasing would show as a large
    // difference.
    SimulationOptions options = smallOptions("livingroom");
    const cv::Mat small = Simulator(options).frame(60).grey;
    options.width = 1280, options.height = 960;
    cv::Mat reference;
    cv::resize(Simulator(options).frame(60).grey, reference, small.size(), 0, 0, cv::INTER_AREA);
    cv::Mat difference;
    cv::absdiff(small, reference, difference);
    EXPECT_LT(cv::mean(difference)[0], 1.5);
    EXPECT_LT(cv::countNonZero(difference > 20) / static_cast<double>(small.total()), 0.005);
}

TEST(Simulator, LensDistortionMovesPixelsAsTheCameraModelSays) {
    SimulationOptions options = smallOptions("livingroom");
    options.distortion = {0.12, -0.2, 0.002, -0.001, 0.05};
    const Simulator simulator(options);
    const SimulatedFrame frame = simulator.frame(5);
    for (int v = 3; v < 120; v += 9)
        for (int u = 3; u < 160; u += 9) {
            Eigen::Vector2d ideal(u, v);
            for (int i = 0; i < 100; ++i)
                ideal += Eigen::Vector2d(u, v) - simulator.camera().distortPixel(ideal);
            const Eigen::Vector3d point =
                simulator.camera().backProject(ideal.x(), ideal.y(), frame.depth.at<float>(v, u));
            const auto& primitive =
                simulator.scene().primitives[static_cast<size_t>(frame.objects.at<int>(v, u))];
            ASSERT_LT(distanceToSurface(primitive, frame.T_world_camera * point), 1e-5);
        }
}

TEST(Simulator, MovingShadowBordersAreMarkedAndOnlyThere) {
    const Simulator shadows(smallOptions("shadows", 900));
    int marked = 0;
    for (int index = 0; index < 900; index += 100) {
        const SimulatedFrame frame = shadows.frame(index);
        const int here = cv::countNonZero(frame.shadow_border);
        marked += here;
        if (here < 50) continue;
        cv::Mat gradient, dx, dy;
        cv::Sobel(frame.grey, dx, CV_32F, 1, 0, 3, 0.125);
        cv::Sobel(frame.grey, dy, CV_32F, 0, 1, 3, 0.125);
        cv::magnitude(dx, dy, gradient);
        EXPECT_GT(cv::mean(gradient, frame.shadow_border)[0], 2 * cv::mean(gradient)[0]) << "frame " << index;
    }
    EXPECT_GT(marked, 500);
    EXPECT_EQ(cv::countNonZero(Simulator(smallOptions("livingroom")).frame(0).shadow_border), 0);
}

TEST(Simulator, ErrorsNameTheOptionAndItsValue) {
    const auto problemOf = [](auto change) {
        SimulationOptions options;
        change(options);
        return options.check();
    };
    EXPECT_EQ(problemOf([](auto&) {}), "");
    for (const auto& [problem, option, value] :
         {std::tuple(problemOf([](auto& o) { o.scene = "attic"; }), "scene", "attic"),
          std::tuple(problemOf([](auto& o) { o.frames = 0; }), "frames", "0"),
          std::tuple(problemOf([](auto& o) { o.fps = -5; }), "fps", "-5"),
          std::tuple(problemOf([](auto& o) { o.depth_noise = std::nan(""); }), "depth_noise", "nan"),
          std::tuple(problemOf([](auto& o) { o.exposure_drift = 2; }), "exposure_drift", "2"),
          std::tuple(problemOf([](auto& o) { o.rolling_shutter = 0.5; }), "rolling_shutter", "0.5"),
          std::tuple(problemOf([](auto& o) { o.width = 7; }), "width", "7")}) {
        EXPECT_NE(problem.find(option), std::string::npos) << problem;
        EXPECT_NE(problem.find(value), std::string::npos) << problem;
    }
    SimulationOptions unknown;
    unknown.scene = "attic";
    EXPECT_NE(unknown.check().find("livingroom, corridor, shadows, block"), std::string::npos);
    EXPECT_THROW(Simulator{unknown}, std::runtime_error);
    EXPECT_THROW(makeScene("attic"), std::runtime_error);
    EXPECT_THROW(pathKindFromName("fly"), std::runtime_error);
    const Simulator simulator(smallOptions("shadows", 3));
    EXPECT_THROW(simulator.frame(3), std::runtime_error);
    EXPECT_THROW(simulator.frame(-1), std::runtime_error);
}

}  // namespace
}  // namespace roevo::simulator
