// Pinhole model: projection, pyramid levels, lens, checks.
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/calib3d.hpp>

#include "core/support/analytic_image.h"
#include "core/support/random_pose.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/image_pyramid.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kCamera{640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};

TEST(PinholeCamera, BackProjectionInvertsProjection) {
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const double u = uniform(random, -50, 700), v = uniform(random, -50, 500),
                     z = uniform(random, 0.1, 20);
        const Eigen::Vector3d point = kCamera.backProject(u, v, z);
        EXPECT_DOUBLE_EQ(point.z(), z);
        EXPECT_LT((kCamera.project(point) - Eigen::Vector2d(u, v)).norm(), 1e-10);
    }
}

TEST(PinholeCamera, PrincipalPointIsOnTheAxis) {
    EXPECT_LT((kCamera.project({0, 0, 3}) - Eigen::Vector2d(318.6, 255.3)).norm(), 1e-12);
    EXPECT_NEAR(kCamera.project({0.1, 0, 1}).x() - 318.6, 51.73, 1e-9);
    EXPECT_NEAR(kCamera.project({0, 0.1, 1}).y() - 255.3, 51.65, 1e-9);
}

// The centroid of a blob is where its point projects, on every level of a pyramid that averages 2x2 pixels.
TEST(PinholeCamera, PyramidLevelsSeeAPointWhereThePyramidShowsIt) {
    const PinholeCamera camera{320, 240, 260, 265, 158.3, 121.9, {}};
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.21, -0.13, 2), Eigen::Vector3d(-0.6, 0.4, 2.5), Eigen::Vector3d(0, 0, 1)}) {
        const Eigen::Vector2d centre = camera.project(point);
        const cv::Mat image = testing::renderGrey(
            320, 240,
            [&](double x, double y) {
                return 250 *
                       std::exp(-((x - centre.x()) * (x - centre.x()) + (y - centre.y()) * (y - centre.y())) /
                                200);
            },
            2);
        ImagePyramid pyramid;
        pyramid.build(image, 4);
        ASSERT_EQ(pyramid.numLevels(), 4);
        for (int level = 0; level < 4; ++level) {
            const cv::Mat& at = pyramid.level(level);
            double sum = 0, sum_u = 0, sum_v = 0;
            for (int v = 0; v < at.rows; ++v) {
                for (int u = 0; u < at.cols; ++u) {
                    const double w = at.at<std::uint8_t>(v, u);
                    sum += w;
                    sum_u += w * u;
                    sum_v += w * v;
                }
            }
            const PinholeCamera scaled = camera.atPyramidLevel(level);
            EXPECT_EQ(scaled.width, at.cols);
            EXPECT_EQ(scaled.height, at.rows);
            const Eigen::Vector2d seen(sum_u / sum, sum_v / sum);
            EXPECT_LT((scaled.project(point) - seen).norm(), 0.02) << "level " << level;
        }
    }
}

TEST(PinholeCamera, PyramidOfARampKeepsItsValuesWhereTheCameraSays) {
    const PinholeCamera camera{128, 96, 100, 100, 63.2, 47.9, {}};
    const cv::Mat ramp = testing::renderGrey(
        128, 96, [](double x, double y) { return 20 + x + 0.75 * y; }, 1);
    ImagePyramid pyramid;
    pyramid.build(ramp, 3);
    for (int level = 0; level < pyramid.numLevels(); ++level) {
        const PinholeCamera scaled = camera.atPyramidLevel(level);
        for (int v = 0; v < scaled.height; v += 5) {
            for (int u = 0; u < scaled.width; u += 5) {
                const Eigen::Vector2d full = camera.project(scaled.backProject(u, v, 1));
                EXPECT_NEAR(pyramid.level(level).at<std::uint8_t>(v, u), 20 + full.x() + 0.75 * full.y(),
                            1.01);
            }
        }
    }
}

TEST(PinholeCamera, PyramidOfOddSizesStaysAligned) {
    const PinholeCamera camera{101, 77, 90, 90, 50, 38, {}};
    const cv::Mat ramp = testing::renderGrey(
        101, 77, [](double x, double y) { return 10 + x + y; }, 1);
    ImagePyramid pyramid;
    pyramid.build(ramp, 2);
    const PinholeCamera half = camera.atPyramidLevel(1);
    ASSERT_EQ(pyramid.level(1).cols, half.width);
    ASSERT_EQ(pyramid.level(1).rows, half.height);
    EXPECT_NEAR(pyramid.level(1).at<std::uint8_t>(37, 49), 10 + 98.5 + 74.5, 1.01);
}

struct Lens {
    const char* name;
    PinholeCamera camera;
    double
        widest;  ///< normalised radius up to which it is tried; beyond, the first is undone to 0.01 px only
};

// A Kinect v1; the colour and the wide depth camera of an Azure Kinect (rational, as one of them was
// calibrated); two fish-eyes, one of them without any term.
const Lens kLenses[] = {
    {"five", kCamera, 0.6},
    {"rational",
     {1280,
      720,
      605.9,
      605.7,
      638.7,
      367.1,
      {0.5163, -2.6274, 0.0006, -0.0002, 1.5198},
      {0.3963, -2.4500, 1.4470}},
     1.2},
    {"wide",
     {1024, 1024, 251.9, 252.0, 511.8, 517.1, {5.0622, 3.2881, 3e-5, 1e-4, 0.1714}, {5.3935, 4.9083, 0.8766}},
     1.6},
    {"fisheye",
     {848,
      800,
      286.2,
      286.3,
      420.1,
      403.2,
      {-0.0091, 0.0474, -0.0460, 0.0092, 0},
      {},
      LensModel::kKannalaBrandt},
     3},
    {"equidistant", {640, 480, 300, 301, 320, 240, {}, {}, LensModel::kKannalaBrandt}, 5}};

class AnyLens : public ::testing::TestWithParam<Lens> {
  protected:
    AnyLens() {
        std::mt19937 random(2);
        for (int i = 0; i < 500; ++i) {
            const double angle = uniform(random, 0, 6.3), r = uniform(random, 0, GetParam().widest);
            rays_.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
        rays_.emplace_back(0, 0);
    }
    const PinholeCamera camera_ = GetParam().camera;
    const bool fisheye_ = camera_.lens == LensModel::kKannalaBrandt;
    const cv::Matx33d K_{camera_.fx, 0, camera_.cx, 0, camera_.fy, camera_.cy, 0, 0, 1};
    std::vector<cv::Point2d> rays_;

    std::vector<double> terms() const {
        std::vector<double> out(camera_.distortion.begin(), camera_.distortion.end());
        if (fisheye_) return {out.begin(), out.begin() + 4};
        out.insert(out.end(), camera_.denominator.begin(), camera_.denominator.end());
        return out;
    }
    Eigen::Vector2d ideal(const cv::Point2d& ray) const { return camera_.project({ray.x, ray.y, 1}); }
};

INSTANTIATE_TEST_SUITE_P(Lenses, AnyLens, ::testing::ValuesIn(kLenses),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(AnyLens, IsThatOfOpenCv) {
    std::vector<cv::Point2d> expected;
    if (fisheye_) {
        cv::fisheye::distortPoints(rays_, expected, K_, terms());
    } else {
        std::vector<cv::Point3d> points;
        for (const cv::Point2d& ray : rays_) points.emplace_back(ray.x, ray.y, 1);
        cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K_, terms(), expected);
    }
    EXPECT_TRUE(camera_.isDistorted());
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Eigen::Vector2d pixel = camera_.distortPixel(ideal(rays_[i]));
        EXPECT_LT(std::hypot(pixel.x() - expected[i].x, pixel.y() - expected[i].y), 1e-9) << rays_[i];
    }
}

TEST_P(AnyLens, IsUndoneAsOpenCvDoes) {
    std::vector<cv::Point2d> pixels, expected;
    for (const cv::Point2d& ray : rays_) {
        const Eigen::Vector2d pixel = camera_.distortPixel(ideal(ray));
        EXPECT_LT((camera_.undistortPixel(pixel) - ideal(ray)).norm(), 1e-4) << ray;
        pixels.emplace_back(pixel.x(), pixel.y());
    }
    const cv::TermCriteria exact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12);
    if (fisheye_)
        cv::fisheye::undistortPoints(pixels, expected, K_, terms(), cv::noArray(), K_);
    else
        cv::undistortPoints(pixels, expected, K_, terms(), cv::noArray(), K_, exact);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Eigen::Vector2d back = camera_.undistortPixel({pixels[i].x, pixels[i].y});
        EXPECT_LT(std::hypot(back.x() - expected[i].x, back.y() - expected[i].y), 1e-3) << rays_[i];
    }
}

// What unfoldedRadiusSquared() says is where the numeric slope of the radius changes its sign.
TEST_P(AnyLens, UnfoldedRadiusIsWhereTheImageTurnsBack) {
    PinholeCamera centred = camera_;
    centred.distortion[2] *= fisheye_;  // tangential terms have no part in it
    centred.distortion[3] *= fisheye_;
    const auto seen = [&](double r) { return centred.distortPixel(centred.project({r, 0, 1})).x(); };
    const double limit = std::sqrt(centred.unfoldedRadiusSquared());
    for (double r = 0.005; r < limit - 0.02; r += 0.005) ASSERT_GT(seen(r + 1e-5), seen(r - 1e-5)) << r;
    if (limit < 9.9) {
        EXPECT_LT(seen(limit + 0.02), seen(limit + 0.01)) << limit;
    }
}

TEST(PinholeCamera, UndistortedHasAnIdealLensAndNothingElseChanged) {
    EXPECT_TRUE(kCamera.isDistorted());
    PinholeCamera ideal = kCamera.undistorted();
    EXPECT_FALSE(ideal.isDistorted());
    EXPECT_NE(ideal, kCamera);
    ideal.distortion = kCamera.distortion;
    EXPECT_EQ(ideal, kCamera);
    for (const Lens& lens : kLenses) {
        PinholeCamera changed = lens.camera.undistorted();
        EXPECT_FALSE(changed.isDistorted());
        changed.distortion = lens.camera.distortion;
        changed.denominator = lens.camera.denominator;
        EXPECT_EQ(changed == lens.camera, lens.camera.lens == LensModel::kBrownConrady) << lens.name;
    }
}

TEST(PinholeCamera, CheckNamesWhatIsWrongAndItsValue) {
    EXPECT_EQ(kCamera.check(), "");
    const auto faultWith = [](auto&& change) {
        PinholeCamera camera = kCamera;
        change(camera);
        return camera.check();
    };
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    EXPECT_NE(faultWith([](auto& c) { c.width = 0; }).find("0x480"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.height = -480; }).find("640x-480"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fx = 0; }).find("fx = 0"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fy = -525; }).find("fy = -525"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fx = 1e-9; }).find("fx = 1e-09"), std::string::npos);
    EXPECT_NE(faultWith([](auto& c) { c.fy = 1e9; }).find("fy = 1e+09"), std::string::npos);
    EXPECT_EQ(faultWith([](auto& c) { c.fx = c.fy = 50; }), "") << "very wide";
    EXPECT_EQ(faultWith([](auto& c) { c.fx = c.fy = 60000; }), "") << "a telescope";
    EXPECT_NE(faultWith([](auto& c) { c.cx = 1000; }).find("1000"), std::string::npos);
    for (const double bad : {nan, inf}) {
        EXPECT_NE(faultWith([&](auto& c) { c.fx = bad; }), "");
        EXPECT_NE(faultWith([&](auto& c) { c.cy = bad; }), "");
        for (std::size_t k = 0; k < 5; ++k) {
            EXPECT_NE(faultWith([&](auto& c) { c.distortion[k] = bad; }).find("distortion"),
                      std::string::npos);
        }
    }
    EXPECT_NE(PinholeCamera().check(), "");
}

TEST(PinholeCamera, CheckFindsALensThatTearsTheImageApart) {
    PinholeCamera camera = kCamera;
    camera.distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
    EXPECT_EQ(camera.check(), "") << "as OpenCV orders them";
    camera.distortion = {0.262383, -0.953104, 1.163314, -0.005358, 0.002628};
    EXPECT_NE(camera.check().find("in the order k1 k2 p1 p2 k3"), std::string::npos) << "k1 k2 k3 p1 p2";
    camera.distortion = {-5, 20, 0, 0, -50};
    EXPECT_NE(camera.check(), "") << "folds";
    camera.distortion = {};
    camera.denominator = {-10, 0, 0};
    EXPECT_NE(camera.check(), "") << "a pole in the image";
    camera.denominator = {-1e300, 1e300, 0};
    EXPECT_NE(camera.check(), "");
    camera.denominator = {};
    camera.distortion = {-0.35, 0.1, 0, 0, 0};
    camera.fx = camera.fy = 320;
    EXPECT_EQ(camera.check(), "") << "a barrel of 90 degrees";
}

TEST(PinholeCamera, FewerDigitsAreNoOtherCamera) {
    const PinholeCamera camera{640,
                               480,
                               517.30642,
                               516.46921,
                               318.64312,
                               255.31398,
                               {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
    PinholeCamera rounded = camera;
    for (double* value : {&rounded.fx, &rounded.fy, &rounded.cx, &rounded.cy})
        *value = std::round(1000 * *value) / 1000;
    EXPECT_FALSE(rounded == camera);
    EXPECT_TRUE(rounded.seesAs(camera));
    PinholeCamera other = camera;
    other.fx += 0.1;  // 0.06 px at the border
    EXPECT_FALSE(other.seesAs(camera));
    other = camera;
    other.distortion[0] += 1e-3;
    EXPECT_FALSE(other.seesAs(camera));
    other = camera;
    other.height = 479;
    EXPECT_FALSE(other.seesAs(camera));
}

}  // namespace
}  // namespace roevo
