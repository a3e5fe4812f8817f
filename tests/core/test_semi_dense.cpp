#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/core.hpp>

#include "mapping/semi_dense.h"

namespace roevo {
namespace {

constexpr int kAll = 1 << 30;
constexpr SurfaceLimits kAnyDepth{1e-3, 1e3, 1e3};

const PinholeCamera kIdeal{160, 120, 140, 145, 81, 58, {}};
const PinholeCamera kDistorted{160, 120, 140, 145, 81, 58, {0.2, -0.3, 0.002, -0.001, 0.05}};

/// Every pixel's colour says where it is (red: column, green: row), and so does its depth.
RgbdFrame addressedFrame() {
    RgbdFrame frame;
    frame.grey.create(120, 160, CV_8UC1);
    frame.depth.create(120, 160, CV_32FC1);
    frame.colour.create(120, 160, CV_8UC3);
    for (int v = 0; v < 120; v++)
        for (int u = 0; u < 160; u++) {
            frame.grey.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(u / 2 + v);
            frame.depth.at<float>(v, u) = 1 + 0.01f * static_cast<float>(u) + 0.02f * static_cast<float>(v);
            frame.colour.at<cv::Vec3b>(v, u) =
                cv::Vec3b(7, static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(u));
        }
    return frame;
}

OrganizedEdges edgeThrough(const std::vector<Eigen::Vector2f>& pixels) {
    OrganizedEdges edges;
    for (const auto& p : pixels) edges.addPoint(p.x(), p.y(), 1, 0, 100);
    edges.finishEdge();
    return edges;
}

OrganizedEdges diagonal() {
    std::vector<Eigen::Vector2f> pixels;
    for (int i = 5; i < 115; i++) pixels.emplace_back(1.3f * static_cast<float>(i), static_cast<float>(i));
    return edgeThrough(pixels);
}

std::array<float, 6> flat(const ColouredPoint& p) {
    return {p.position.x(),
            p.position.y(),
            p.position.z(),
            static_cast<float>(p.colour[0]),
            static_cast<float>(p.colour[1]),
            static_cast<float>(p.colour[2])};
}

TEST(SemiDense, PointsProjectToThePixelThatTheirColourAndDepthAreOf) {
    for (const PinholeCamera& camera : {kIdeal, kDistorted}) {
        const auto points = sampleSemiDense(diagonal(), addressedFrame(), camera, 4, kAnyDepth, kAll);
        EXPECT_GT(points.size(), 700u);
        for (const ColouredPoint& point : points) {
            const float u = point.colour[0], v = point.colour[1];
            EXPECT_EQ(point.colour[2], 7);
            EXPECT_FLOAT_EQ(point.position.z(), 1 + 0.01f * u + 0.02f * v);
            const Eigen::Vector2d real = camera.distortPixel(camera.project(point.position.cast<double>()));
            // The nearest pixel of the real lens
            EXPECT_NEAR(real.x(), static_cast<double>(u), 0.501);
            EXPECT_NEAR(real.y(), static_cast<double>(v), 0.501);
        }
    }
}

TEST(SemiDense, TakesThePixelsWithinTheRadiusOnceAndOnlyInsideTheImage) {
    const auto count = [](const std::vector<Eigen::Vector2f>& pixels, int radius) {
        return sampleSemiDense(edgeThrough(pixels), addressedFrame(), kIdeal, radius, kAnyDepth, kAll).size();
    };
    EXPECT_EQ(count({{50.4f, 39.6f}}, 0), 1u);
    EXPECT_EQ(count({{50, 40}}, 1), 5u);
    EXPECT_EQ(count({{50, 40}}, 3), 29u);
    EXPECT_EQ(count({{50, 40}, {50, 40}}, 3), 29u);
    EXPECT_EQ(count({{50, 40}, {80, 40}}, 3), 58u);
    EXPECT_EQ(count({{0, 0}}, 2), 6u);
    EXPECT_EQ(count({{159, 119}}, 2), 6u);
    EXPECT_EQ(count({{-2, 40}}, 2), 1u);
    EXPECT_EQ(count({{300, 40}, {40, -50}}, 2), 0u);
    EXPECT_EQ(count({}, 2), 0u);
}

TEST(SemiDense, PixelsWithoutDepthAreLeftOut) {
    RgbdFrame frame = addressedFrame();
    const auto edges = edgeThrough({{50, 40}});
    frame.depth.at<float>(40, 50) = 0;
    frame.depth.at<float>(40, 51) = std::numeric_limits<float>::quiet_NaN();
    frame.depth.at<float>(40, 49) = std::numeric_limits<float>::infinity();
    frame.depth.at<float>(41, 50) = -1;
    const auto points = sampleSemiDense(edges, frame, kIdeal, 1, kAnyDepth, kAll);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].colour, (Rgb{50, 39, 7}));
    frame.depth.release();
    EXPECT_TRUE(sampleSemiDense(edges, frame, kIdeal, 1, kAnyDepth, kAll).empty());
}

TEST(SemiDense, NoneWhereTheLensLeadsOutOfTheImage) {
    for (const double k1 : {100., -1e300, 1e300}) {
        PinholeCamera camera = kIdeal;
        camera.distortion[0] = k1;
        EXPECT_TRUE(
            sampleSemiDense(edgeThrough({{5, 5}}), addressedFrame(), camera, 2, kAnyDepth, kAll).empty())
            << k1;
    }
}

TEST(SemiDense, GreyWhereTheFrameHasNoColour) {
    RgbdFrame frame = addressedFrame();
    frame.colour.release();
    const auto points = sampleSemiDense(edgeThrough({{50, 40}}), frame, kIdeal, 0, kAnyDepth, kAll);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].colour, (Rgb{65, 65, 65}));
}

TEST(SemiDense, ThinsEvenlyAndTheSameWayEachTime) {
    const auto all = sampleSemiDense(diagonal(), addressedFrame(), kDistorted, 4, kAnyDepth, kAll);
    const int wanted = 200;
    const auto some = sampleSemiDense(diagonal(), addressedFrame(), kDistorted, 4, kAnyDepth, wanted);
    const auto again = sampleSemiDense(diagonal(), addressedFrame(), kDistorted, 4, kAnyDepth, wanted);
    ASSERT_EQ(some.size(), 200u);
    ASSERT_EQ(again.size(), some.size());
    for (std::size_t i = 0; i < some.size(); i++) EXPECT_EQ(flat(some[i]), flat(again[i]));
    for (const ColouredPoint& point : some)
        EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                                [&](const ColouredPoint& p) { return flat(p) == flat(point); }));
    // Every quarter of the picture's height keeps its share
    for (int quarter = 0; quarter < 4; quarter++) {
        const auto here = [&](const ColouredPoint& p) { return p.colour[1] / 30 == quarter; };
        const double share = static_cast<double>(std::count_if(all.begin(), all.end(), here)) /
                             static_cast<double>(all.size());
        EXPECT_NEAR(static_cast<double>(std::count_if(some.begin(), some.end(), here)), wanted * share, 1.01);
    }
    EXPECT_EQ(sampleSemiDense(diagonal(), addressedFrame(), kIdeal, 4, kAnyDepth, 1).size(), 1u);
    EXPECT_TRUE(sampleSemiDense(diagonal(), addressedFrame(), kIdeal, 4, kAnyDepth, 0).empty());
}

}  // namespace
}  // namespace roevo
