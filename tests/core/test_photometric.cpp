// Photometric residuals of oriented patches on a smooth, slanted, textured plane.
#include <gtest/gtest.h>

#include "core/support/random_pose.h"
#include "core/support/textured_plane.h"
#include "edges/gradient.h"
#include "tracking/coarse_tracker.h"
#include "tracking/gauss_newton.h"
#include "tracking/robust.h"

namespace roevo {
namespace {

const PinholeCamera kHalfCamera{320, 240, 260, 262, 158.7, 120.4, {}};

/// Keyframe points on a lattice over the plane, as if edges ran there.
struct World {
    testing::TexturedPlane plane;
    ImagePyramid pyramid;
    EdgePoints3D edges;
    PhotometricPoints points;

    /// @param contrast, offset  of the image's grey levels
    explicit World(double contrast = 1, double offset = 0) {
        const cv::Mat image = plane.grey(kHalfCamera, Pose::Identity(), contrast, offset);
        pyramid.build(image, 3);
        Gradient gradient;
        computeGradient(image, 0, gradient);
        for (int v = 40; v < 200; v += 7) {
            for (int u = 50; u < 270; u += 5) {
                const float magnitude = gradient.magnitude.at<float>(v, u);
                if (static_cast<double>(magnitude) < 16 * contrast) continue;
                edges.image.addPoint(static_cast<float>(u), static_cast<float>(v),
                                     static_cast<float>(gradient.gx.at<std::int16_t>(v, u)) / magnitude,
                                     static_cast<float>(gradient.gy.at<std::int16_t>(v, u)) / magnitude,
                                     magnitude / 8);
                edges.points.add(
                    kHalfCamera.backProject(u, v, plane.depth(kHalfCamera, Pose::Identity(), u, v)));
                edges.weight.push_back(1);
            }
            edges.image.finishEdge();
        }
        edges.points.pad();
        points = samplePhotometricPoints(edges, pyramid, 100000);
    }
};

/// The term's normal equations at a pose.
PoseSystem linearised(PhotometricTerm& term, const Pose& pose) {
    PoseSystem system;
    EXPECT_TRUE(term.linearise({pose, RowMotion(), 0}, system));
    return system;
}

TEST(Photometric, SameImageAtIdentityHasNoResidualOnAnyLevel) {
    const World world;
    ASSERT_GT(world.points.size(), 500U);
    for (int level = 0; level < 3; ++level) {
        PhotometricTerm term;
        const PinholeCamera camera = kHalfCamera.atPyramidLevel(level);
        term.start(world.points, level, world.pyramid.level(level), camera, {});
        const PoseSystem system = linearised(term, Pose::Identity());
        EXPECT_GT(term.numVisible(), static_cast<int>(world.points.size()) * 9 / 10);
        // The points come back to their pixels up to single precision
        EXPECT_LT(term.cost(), 0.02) << "level " << level;
        EXPECT_LT(system.solve().norm(), 1e-5);
    }
}

// The gradient that linearise() gives is the derivative of the weighted cost: checked along each axis of the
// pose by differencing the pose itself, with the weights held, on the current image's own slopes.
TEST(Photometric, GradientPredictsHowThePoseErrorShows) {
    const World world;
    std::mt19937 random(111);
    for (int level = 0; level < 2; ++level) {
        const PinholeCamera camera = kHalfCamera.atPyramidLevel(level);
        for (int k = 0; k < 12; ++k) {
            Vector6d xi = Vector6d::Zero();
            xi[k / 2] = (k % 2 == 0 ? 1 : -1) * (k / 2 < 3 ? 0.003 : 0.002);
            PhotometricTerm term;
            term.start(world.points, level, world.pyramid.level(level), camera, {});
            // One Gauss-Newton step undoes a small error nearly wholly; a wrong sign or scale in any column
            // does not
            const Vector6d left = xi + linearised(term, poseIncrement(xi)).solve();
            EXPECT_LT(left.head<3>().norm() / 2 + left.tail<3>().norm(),
                      0.15 * (xi.head<3>().norm() / 2 + xi.tail<3>().norm()))
                << "level " << level << " axis " << k / 2;
        }
    }
}

/// A reference of half the contrast, and images of it with any gain from 0.5 to 2.5 of which nothing
/// saturates.
class Gains : public ::testing::TestWithParam<double> {
  protected:
    static constexpr double kContrast = 0.5, kDark = 2.5;  // grey levels about 20 to 110

    Brightness brightness() const { return {GetParam(), 128 - 65 * GetParam()}; }
    cv::Mat seenFrom(const Pose& T_world_camera) const {
        const auto [gain, offset] = brightness();
        cv::Mat image =
            world_.plane.grey(kHalfCamera, T_world_camera, gain * kContrast, gain * kDark + offset);
        double least = 0, most = 0;
        cv::minMaxLoc(image, &least, &most);
        EXPECT_GT(least, 0);
        EXPECT_LT(most, 255);
        return image;
    }

    const World world_{kContrast, kDark};
};

/// The cost that linearise() differentiates, with the weights held that it has at one pose.
class HeldCost {
  public:
    HeldCost(const PhotometricPoints& points, const cv::Mat& image, const Pose& pose,
             const Brightness& brightness)
        : points_(points), image_(image), brightness_(brightness) {
        PhotometricTerm term;
        term.start(points, 0, image, kHalfCamera, brightness);
        term.evaluate(pose, RowMotion());
        const double scale = std::max(1.0, term.cost());  // grey levels
        const double information = 1 / (scale * scale);
        for (const kernels::PatchResidual& patch : patchesAt(pose)) {
            const double squared = static_cast<double>(patch.squared) * information / kernels::kPatchSize;
            const auto weight = static_cast<double>(points.weight[weight_.size()]);
            weight_.push_back(patch.squared < 0 ? 0 : information * studentWeight(weight, squared));
        }
    }
    double at(const Pose& pose) const {
        const auto patches = patchesAt(pose);
        double sum = 0;
        for (std::size_t i = 0; i < patches.size(); ++i) {
            EXPECT_GE(patches[i].squared, 0) << "left the image";
            sum += weight_[i] * static_cast<double>(patches[i].squared) / 2;
        }
        return sum;
    }

  private:
    std::vector<kernels::PatchResidual> patchesAt(const Pose& pose) const {
        const std::size_t n = points_.size();
        std::vector<float> axis_x(n), axis_y(n);
        ProjectedPoints3 projected;
        project(points_.points, pose, kHalfCamera, RowMotion(), projected);
        const Eigen::Vector2f turn = imageRotation(pose);
        for (std::size_t i = 0; i < n; ++i) {
            axis_x[i] = turn.x() * points_.axis_x[i] - turn.y() * points_.axis_y[i];
            axis_y[i] = turn.y() * points_.axis_x[i] + turn.x() * points_.axis_y[i];
        }
        std::vector<kernels::PatchResidual> patches(n);
        kernels::best().patches(
            {image_.ptr<std::uint8_t>(), static_cast<std::ptrdiff_t>(image_.step), image_.cols, image_.rows},
            points_.patches[0].data(), projected.u.data(), projected.v.data(), axis_x.data(), axis_y.data(),
            n, static_cast<float>(brightness_.gain), static_cast<float>(brightness_.offset), patches.data());
        return patches;
    }

    const PhotometricPoints& points_;
    const cv::Mat& image_;
    Brightness brightness_;
    std::vector<double> weight_;
};

Pose moved(const Pose& pose, int axis, double by) {
    Vector6d step = Vector6d::Zero();
    step[axis] = by;
    return poseIncrement(step) * pose;
}

PoseSystem accumulated(const World& world, const cv::Mat& image, const Pose& pose,
                       const Brightness& brightness) {
    PhotometricTerm term;
    term.start(world.points, 0, image, kHalfCamera, brightness);
    return linearised(term, pose);
}

// The residual is I_c - gain I_r - offset, and I_c is differentiated by the reference's slopes times the
// gain. It was without the gain: gradients too small and Hessians too small by its square, so that steps were
// too long by the gain (and too short below 1). Slopes of the reference are those of the current image only
// where they show the same, thus the tolerance; without the gain the errors are a fifth and more.
constexpr double kSlopesDiffer = 0.12;

TEST_P(Gains, GradientIsThatOfTheNumericCost) {
    ASSERT_GT(world_.points.size(), 500U);
    std::mt19937 random(112);
    for (int repeat = 0; repeat < 3; ++repeat) {
        const Pose T_world_camera = testing::randomPose(random, 0.02, 0.01), truth = T_world_camera.inverse();
        const cv::Mat image = seenFrom(T_world_camera);
        Vector6d off;  // up to a pixel; rotations do not make up for translations
        for (int k = 0; k < 6; ++k)
            off[k] = (testing::uniform(random, 0, 1) < 0.5 ? -1 : 1) * (k < 3 ? 0.006 : 0.0015);
        const Pose pose = poseIncrement(off) * truth;
        const PoseSystem system = accumulated(world_, image, pose, brightness());
        const HeldCost cost(world_.points, image, pose, brightness());
        Vector6d error, numeric;  // each axis in its own unit
        for (int k = 0; k < 6; ++k) {
            const double step = k < 3 ? 0.002 : 0.001;  // a quarter of a pixel: pixels are noisy
            const double slope =
                (cost.at(moved(pose, k, step)) - cost.at(moved(pose, k, -step))) / (2 * step);
            const double unit = std::sqrt(system.hessian(k, k));
            numeric[k] = slope / unit;
            error[k] = system.gradient[k] / unit - numeric[k];
        }
        EXPECT_LT(error.norm(), kSlopesDiffer * numeric.norm())
            << error.transpose() << " of " << numeric.transpose();
    }
}

TEST_P(Gains, HessianIsThatOfTheNumericCost) {
    std::mt19937 random(115);
    const Pose T_world_camera = testing::randomPose(random, 0.02, 0.01), truth = T_world_camera.inverse();
    const cv::Mat image = seenFrom(T_world_camera);
    const PoseSystem system = accumulated(world_, image, truth, brightness());
    const HeldCost cost(world_.points, image, truth, brightness());
    for (int k = 0; k < 6; ++k) {
        const double step = k < 3 ? 0.006 : 0.003;
        const double curvature =
            (cost.at(moved(truth, k, step)) - 2 * cost.at(truth) + cost.at(moved(truth, k, -step))) /
            (step * step);
        EXPECT_NEAR(system.hessian(k, k) / curvature, 1, kSlopesDiffer) << "axis " << k;
    }
}

// Steps that were too long by the gain swung about the truth at 1.5, and away from it from 2 on.
TEST_P(Gains, AFewStepsFindThePoseAndTheBrightness) {
    std::mt19937 random(116);
    for (int repeat = 0; repeat < 3; ++repeat) {
        const Pose T_world_camera = testing::randomPose(random, 0.01, 0.005);
        const cv::Mat image = seenFrom(T_world_camera);
        PhotometricTerm photometric;
        photometric.start(world_.points, 0, image, kHalfCamera,
                          {0.97 * GetParam(), brightness().offset});  // of the frame before
        DampingTerm damping(0.4, 0.2);
        const GaussNewtonOptions options{12, kHalfCamera.fx, 2};
        const GaussNewtonResult found =
            minimise(Pose::Identity(), RollingShutter(), {&photometric, &damping}, options);
        EXPECT_TRUE(found.complete);
        EXPECT_LT(found.iterations, 12) << "settled before that";
        const Pose error = found.T_current_keyframe * T_world_camera;
        EXPECT_LT(error.translation().norm(), 2e-3);
        EXPECT_LT(rotationAngle(error), 1e-3);
        EXPECT_NEAR(photometric.bestBrightness().gain, GetParam(), 0.015 * GetParam());
        EXPECT_NEAR(photometric.bestBrightness().offset, brightness().offset, 4);
    }
}

INSTANTIATE_TEST_SUITE_P(Photometric, Gains, ::testing::Values(0.5, 0.8, 1.0, 1.5, 2.5));

TEST(Photometric, RepeatedStepsFindTheTruthFromANewView) {
    const World world;
    std::mt19937 random(113);
    for (int repeat = 0; repeat < 5; ++repeat) {
        const Pose T_world_camera = testing::randomPose(random, 0.03, 0.02);
        const cv::Mat image = world.plane.grey(kHalfCamera, T_world_camera);
        const Pose truth = T_world_camera.inverse();
        Pose pose = Pose::Identity();
        PhotometricTerm term;
        term.start(world.points, 0, image, kHalfCamera, {});
        for (int i = 0; i < 12; ++i) pose = poseIncrement(linearised(term, pose).solve()) * pose;
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
        PhotometricTerm term;
        term.start(world.points, 0, image, kHalfCamera, {});
        for (int i = 0; i < 3; ++i) {
            term.evaluate(Pose::Identity(), RowMotion());
            term.update();
        }
        term.keep();
        EXPECT_NEAR(term.bestBrightness().gain, gain, 0.01);
        EXPECT_NEAR(term.bestBrightness().offset, offset, 1);
    }
}

TEST(Photometric, WithoutContrastTheBrightnessStaysAsItWas) {
    World world;
    for (auto& patch : world.points.patches[0]) {
        for (float& value : patch.intensity) value = 100;
        patch.sum = 800;
        patch.sum_squared = 80000;
    }
    PhotometricTerm term;
    term.start(world.points, 0, world.pyramid.level(0), kHalfCamera, {1.3, 7});
    term.evaluate(Pose::Identity(), RowMotion());
    term.update();
    term.keep();
    EXPECT_EQ(term.bestBrightness().gain, 1.3);
    EXPECT_EQ(term.bestBrightness().offset, 7);
}

TEST(Photometric, NothingVisibleCarriesNoInformation) {
    const World world;
    Pose away = Pose::Identity();
    away.translation().x() = 50;
    PhotometricTerm term;
    term.start(world.points, 0, world.pyramid.level(0), kHalfCamera, {});
    const PoseSystem system = linearised(term, away);
    EXPECT_EQ(term.numVisible(), 0);
    EXPECT_EQ(system.hessian.norm(), 0);
    EXPECT_EQ(system.gradient.norm(), 0);
}

TEST(Photometric, SamplingSpreadsOverTheEdgesAndKeepsItsLimit) {
    const World world;
    for (const int limit : {50, 200, 1500}) {
        const PhotometricPoints some = samplePhotometricPoints(world.edges, world.pyramid, limit);
        EXPECT_LE(some.size(),
                  static_cast<std::size_t>(limit) + static_cast<std::size_t>(world.edges.image.numEdges()));
        EXPECT_GE(some.size(),
                  std::min<std::size_t>(static_cast<std::size_t>(limit) / 2, world.edges.size()));
        EXPECT_EQ(some.points.size() % kernels::kLanes, 0U);
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
        cv::Mat image = world.plane.grey(kHalfCamera, T_world_camera);
        image.convertTo(image, CV_8U, 0.8, 15);
        ImagePyramid pyramid;
        pyramid.build(image, 3);
        CoarseTracker tracker{CoarseOptions()};
        const CoarseResult result =
            tracker.track(keyframe, pyramid, kHalfCamera, RollingShutter(), {Pose::Identity()}, Brightness());
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
    const CoarseResult result = CoarseTracker{CoarseOptions()}.track(keyframe, world.pyramid, kHalfCamera,
                                                                     RollingShutter(), {guess}, Brightness());
    EXPECT_FALSE(result.converged);
    EXPECT_EQ((result.T_current_keyframe.matrix() - guess.matrix()).norm(), 0);
}

}  // namespace
}  // namespace roevo
