// Depth of map edges, smoothed along them.
#include <gtest/gtest.h>

#include "core/support/mapping_world.h"
#include "mapping/edge_smoothing.h"

namespace roevo {
namespace {

using namespace testing;

constexpr double kNoise = 1.4e-3;  // 1/m

/// All of whose noise grows with depth.
SensorOptions sensor() {
    SensorOptions options;
    options.depth_noise = kNoise;
    options.depth_noise_floor = 0;
    return options;
}

/// The points of a curve as seen from `camera`, their depths off by noise.
std::vector<Eigen::Vector3d> seen(const Curve& curve, const Pose& camera, double sigmas, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < curve.samples(); i += 3) {
        Eigen::Vector3d q = camera.inverse() * curve.at(i * curve.spacing);
        q *= 1 + sigmas * kNoise * q.z() * normal(random);
        points.push_back(camera * q);
    }
    return points;
}

double rmsDistance(const Curve& curve, const std::vector<Eigen::Vector3d>& points) {
    double sum = 0;
    for (const auto& p : points) sum += std::pow(distanceTo(curve, p), 2);
    return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(EdgeSmoothing, NoisyEdgesComeNearerToTheTruth) {
    const auto curves = room();
    for (const int place : {0, 5}) {
        const Pose camera = placeOnPath(place);
        for (std::size_t c = 0; c < curves.size(); ++c) {
            auto points = seen(curves[c], camera, 1, static_cast<unsigned>(c));
            const double before = rmsDistance(curves[c], points);
            smoothDepthAlong(points, camera, sensor());
            EXPECT_LT(rmsDistance(curves[c], points), 0.6 * before) << "curve " << c;
        }
    }
}

TEST(EdgeSmoothing, StraightEdgesWithoutNoiseStayWhereTheyAre) {
    const Pose camera = placeOnPath(3);
    for (const Curve& curve : {room()[0], room()[4]}) {  // across the view, and away from it
        auto points = seen(curve, camera, 0, 1);
        const auto before = points;
        smoothDepthAlong(points, camera, sensor());
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - before[i]).norm(), 1e-9);
    }
}

TEST(EdgeSmoothing, TheImageOfAnEdgeStays) {
    const Pose camera = placeOnPath(4);
    auto points = seen(room()[3], camera, 1, 2);
    const auto before = points;
    smoothDepthAlong(points, camera, sensor());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto a = mappingCamera().project(camera.inverse() * before[i]);
        EXPECT_LT((a - mappingCamera().project(camera.inverse() * points[i])).norm(), 1e-9);
    }
}

TEST(EdgeSmoothing, AStepStays) {
    // Half of the edge 30 cm behind the other half, as where one object hides another
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 40; ++i) {
        const double z = i < 20 ? 2.0 : 2.3;
        points.emplace_back((i - 20) * 0.005 * z, 0.1 * z, z);
    }
    const auto before = points;
    smoothDepthAlong(points, Pose::Identity(), sensor());
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - before[i]).norm(), 0.02) << i;
}

TEST(EdgeSmoothing, OddEdgesAreLeftAlone) {
    std::vector<Eigen::Vector3d> none, two{{0, 0, 1}, {0.1, 0, 1}};
    smoothDepthAlong(none, Pose::Identity(), sensor());
    smoothDepthAlong(two, Pose::Identity(), sensor());
    EXPECT_EQ(two[1], Eigen::Vector3d(0.1, 0, 1));
    std::vector<Eigen::Vector3d> same(9, Eigen::Vector3d(0, 0, 2)), behind(9, Eigen::Vector3d(0, 0, -1));
    smoothDepthAlong(same, Pose::Identity(), sensor());
    smoothDepthAlong(behind, Pose::Identity(), sensor());
    EXPECT_EQ(same[4], Eigen::Vector3d(0, 0, 2));
    EXPECT_EQ(behind[4], Eigen::Vector3d(0, 0, -1));
}

}  // namespace
}  // namespace roevo
