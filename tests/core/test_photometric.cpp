// Photometric residuals of oriented patches on a smooth, slanted, textured plane.
#include <gtest/gtest.h>

#include "core/support/random_pose.h"
#include "core/support/textured_plane.h"
#include "roevo/edges/gradient.h"
#include "roevo/tracking/coarse_tracker.h"
#include "roevo/tracking/gauss_newton.h"

namespace roevo {
namespace {

const PinholeCamera kCamera{320, 240, 260, 262, 158.7, 120.4, {}};

/// Keyframe points on a lattice over the plane, as if edges ran there.
struct World {
    testing::TexturedPlane plane;
    ImagePyramid pyramid;
    EdgePoints3D edges;
    PhotometricPoints points;

    World() {
        const cv::Mat image = plane.grey(kCamera, Pose::Identity());
        pyramid.build(image, 3);
        Gradient gradient;
        computeGradient(image, 0, gradient);
        edges.image.clear();
        for (int v = 40; v < 200; v += 7) {
            for (int u = 50; u < 270; u += 5) {
                const float magnitude = gradient.magnitude.at<float>(v, u);
                if (magnitude < 16) continue;
                edges.image.addPoint(static_cast<float>(u), static_cast<float>(v),
                                     static_cast<float>(gradient.gx.at<std::int16_t>(v, u)) / magnitude,
                                     static_cast<float>(gradient.gy.at<std::int16_t>(v, u)) / magnitude,
                                     magnitude / 8);
                const Eigen::Vector3d p =
                    kCamera.backProject(u, v, plane.depth(kCamera, Pose::Identity(), u, v));
                edges.x.push_back(static_cast<float>(p.x()));
                edges.y.push_back(static_cast<float>(p.y()));
                edges.z.push_back(static_cast<float>(p.z()));
                edges.weight.push_back(1);
            }
            edges.image.finishEdge();
        }
        const std::size_t padded = kernels::paddedSize(edges.size());
        edges.x.resize(padded, 0);
        edges.y.resize(padded, 0);
        edges.z.resize(padded, 1);
        points = samplePhotometricPoints(edges, pyramid, 100000);
    }
};

TEST(Photometric, SameImageAtIdentityHasNoResidualOnAnyLevel) {
    const World world;
    ASSERT_GT(world.points.size(), 500U);
    for (int level = 0; level < 3; ++level) {
        PhotometricResiduals residuals;
        const PinholeCamera camera = kCamera.atPyramidLevel(level);
        residuals.evaluate(world.points, level, world.pyramid.level(level), camera, Pose::Identity(),
                           RowMotion(), {});
        EXPECT_GT(residuals.numVisible(), static_cast<int>(world.points.size()) * 9 / 10);
        // The points come back to their pixels up to single precision
        EXPECT_LT(residuals.cost(), 0.02) << "level " << level;
        kernels::NormalEquations equations;
        residuals.accumulate(world.points, level, camera, 1, equations);
        PoseSystem system;
        system.add(equations);
        EXPECT_LT(system.solve().norm(), 1e-5);
    }
}

// The gradient that accumulate() gives is the derivative of the weighted cost: checked along each axis of the
// pose by differencing the pose itself, with the weights held, on the current image's own slopes.
TEST(Photometric, GradientPredictsHowThePoseErrorShows) {
    const World world;
    std::mt19937 random(111);
    for (int level = 0; level < 2; ++level) {
        const PinholeCamera camera = kCamera.atPyramidLevel(level);
        for (int k = 0; k < 12; ++k) {
            Vector6d xi = Vector6d::Zero();
            xi[k / 2] = (k % 2 == 0 ? 1 : -1) * (k / 2 < 3 ? 0.003 : 0.002);
            PhotometricResiduals residuals;
            residuals.evaluate(world.points, level, world.pyramid.level(level), camera, poseIncrement(xi),
                               RowMotion(), {});
            kernels::NormalEquations equations;
            residuals.accumulate(world.points, level, camera, 1, equations);
            PoseSystem system;
            system.add(equations);
            // One Gauss-Newton step undoes a small error nearly wholly; a wrong sign or scale in any column
            // does not
            const Vector6d left = xi + system.solve();
            EXPECT_LT(left.head<3>().norm() / 2 + left.tail<3>().norm(),
                      0.15 * (xi.head<3>().norm() / 2 + xi.tail<3>().norm()))
                << "level " << level << " axis " << k / 2;
        }
    }
}

TEST(Photometric, HessianAndGradientAreThoseOfTheNumericCost) {
    const World world;
    std::mt19937 random(112);
    // Sum over all patches of squared residuals by brute force, through public calls: with all points alike
    // in weight the robust cost is monotone in it, so compare directions: the gradient must point uphill
    // along random directions.
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Pose pose = testing::randomPose(random, 0.01, 0.006);
        PhotometricResiduals residuals;
        residuals.evaluate(world.points, 0, world.pyramid.level(0), kCamera, pose, RowMotion(), {});
        const double before = residuals.cost();
        kernels::NormalEquations equations;
        residuals.accumulate(world.points, 0, kCamera, 1, equations);
        PoseSystem system;
        system.add(equations);
        const Vector6d step = system.solve();
        residuals.evaluate(world.points, 0, world.pyramid.level(0), kCamera, poseIncrement(step) * pose,
                           RowMotion(), {});
        EXPECT_LT(residuals.cost(), 0.3 * before);
    }
}

TEST(Photometric, RepeatedStepsFindTheTruthFromANewView) {
    const World world;
    std::mt19937 random(113);
    for (int repeat = 0; repeat < 5; ++repeat) {
        const Pose T_world_camera = testing::randomPose(random, 0.03, 0.02);
        const cv::Mat image = world.plane.grey(kCamera, T_world_camera);
        const Pose truth = T_world_camera.inverse();
        Pose pose = Pose::Identity();
        PhotometricResiduals residuals;
        for (int i = 0; i < 12; ++i) {
            residuals.evaluate(world.points, 0, image, kCamera, pose, RowMotion(), {});
            kernels::NormalEquations equations;
            residuals.accumulate(world.points, 0, kCamera, 1, equations);
            PoseSystem system;
            system.add(equations);
            pose = poseIncrement(system.solve()) * pose;
        }
        const Pose error = pose * truth.inverse();
        EXPECT_LT(error.translation().norm(), 1e-3);
        EXPECT_LT(rotationAngle(error), 5e-4);
    }
}

TEST(Photometric, BrightnessFitRecoversGainAndOffset) {
    const World world;
    for (const auto& [gain, offset] : {std::pair(0.7, 20.0), {1.0, -15.0}, {0.5, 60.0}, {1.0, 0.0}}) {
        cv::Mat image;
        world.pyramid.level(0).convertTo(image, CV_8U, gain, offset);
        PhotometricResiduals residuals;
        Brightness fitted;
        for (int i = 0; i < 3; ++i) {
            residuals.evaluate(world.points, 0, image, kCamera, Pose::Identity(), RowMotion(), fitted);
            fitted = residuals.fitBrightness(world.points, 0, fitted);
        }
        EXPECT_NEAR(fitted.gain, gain, 0.01);
        EXPECT_NEAR(fitted.offset, offset, 1);
    }
}

TEST(Photometric, WithoutContrastTheBrightnessStaysAsItWas) {
    World world;
    for (auto& patch : world.points.patches[0]) {
        for (float& value : patch.intensity) value = 100;
        patch.sum = 800;
        patch.sum_squared = 80000;
    }
    PhotometricResiduals residuals;
    residuals.evaluate(world.points, 0, world.pyramid.level(0), kCamera, Pose::Identity(), RowMotion(),
                       {1.3, 7});
    const Brightness fitted = residuals.fitBrightness(world.points, 0, {1.3, 7});
    EXPECT_EQ(fitted.gain, 1.3);
    EXPECT_EQ(fitted.offset, 7);
}

TEST(Photometric, NothingVisibleCarriesNoInformation) {
    const World world;
    Pose away = Pose::Identity();
    away.translation().x() = 50;
    PhotometricResiduals residuals;
    residuals.evaluate(world.points, 0, world.pyramid.level(0), kCamera, away, RowMotion(), {});
    EXPECT_EQ(residuals.numVisible(), 0);
    kernels::NormalEquations equations;
    residuals.accumulate(world.points, 0, kCamera, 1, equations);
    for (const double value : equations.hessian) EXPECT_EQ(value, 0);
    for (const double value : equations.gradient) EXPECT_EQ(value, 0);
}

TEST(Photometric, SamplingSpreadsOverTheEdgesAndKeepsItsLimit) {
    const World world;
    for (const int limit : {50, 200, 1500}) {
        const PhotometricPoints some = samplePhotometricPoints(world.edges, world.pyramid, limit);
        EXPECT_LE(some.size(),
                  static_cast<std::size_t>(limit) + static_cast<std::size_t>(world.edges.image.numEdges()));
        EXPECT_GE(some.size(),
                  std::min<std::size_t>(static_cast<std::size_t>(limit) / 2, world.edges.size()));
        EXPECT_EQ(some.x.size() % kernels::kLanes, 0U);
        EXPECT_EQ(some.patches.size(), 3U);
    }
    EXPECT_EQ(samplePhotometricPoints(EdgePoints3D(), world.pyramid, 100).size(), 0U);
}

TEST(Photometric, ImageDirectionsTurnWithTheCamera) {
    Pose roll = Pose::Identity();
    roll.setRotation(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    const Eigen::Vector2f turn = imageRotation(roll);
    EXPECT_NEAR(turn.x(), std::cos(0.3), 1e-6);
    EXPECT_NEAR(turn.y(), std::sin(0.3), 1e-6);
}

TEST(CoarseTracker, FindsALargeMotionOverThePyramidWithChangedBrightness) {
    World world;
    Keyframe keyframe;
    keyframe.photometric = world.points;
    keyframe.median_depth = 2;
    std::mt19937 random(114);
    for (int repeat = 0; repeat < 5; ++repeat) {
        const Pose T_world_camera = testing::randomPose(random, 0.06, 0.04);
        cv::Mat image = world.plane.grey(kCamera, T_world_camera);
        image.convertTo(image, CV_8U, 0.8, 15);
        ImagePyramid pyramid;
        pyramid.build(image, 3);
        CoarseTracker tracker{CoarseOptions()};
        const CoarseResult result =
            tracker.track(keyframe, pyramid, kCamera, RollingShutter(), {Pose::Identity()}, Brightness());
        ASSERT_TRUE(result.converged);
        const Pose error = result.T_current_keyframe * T_world_camera;
        EXPECT_LT(error.translation().norm(), 3e-3);
        EXPECT_LT(rotationAngle(error), 1.5e-3);
        EXPECT_NEAR(result.brightness.gain, 0.8, 0.03);
        EXPECT_NEAR(result.brightness.offset, 15, 4);
    }
}

TEST(CoarseTracker, TooFewPointsDoNotConvergeAndKeepTheGuess) {
    World world;
    Keyframe keyframe;
    keyframe.median_depth = 2;
    Pose guess = Pose::Identity();
    guess.translation().x() = 0.1;
    const CoarseResult result = CoarseTracker{CoarseOptions()}.track(keyframe, world.pyramid, kCamera,
                                                                     RollingShutter(), {guess}, Brightness());
    EXPECT_FALSE(result.converged);
    EXPECT_EQ((result.T_current_keyframe.matrix() - guess.matrix()).norm(), 0);
}

}  // namespace
}  // namespace roevo
