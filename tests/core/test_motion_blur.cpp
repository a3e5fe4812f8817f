// What motion takes from the certainty of an edge's place.
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/random_pose.h"
#include "tracking/motion_blur.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kTallCamera{640, 480, 525, 540, 319.5, 239.5, {}};
constexpr double kSeconds = 0.005;

RowMotion randomRows(std::mt19937& random) {
    RowMotion rows;
    for (int k = 0; k < 3; ++k) {
        rows.velocity[k] = uniform(random, -0.5, 0.5);
        rows.turn[k] = uniform(random, -1, 1);
    }
    return rows;
}

Eigen::Vector3d randomPoint(std::mt19937& random) {
    const double z = uniform(random, 0.5, 5);
    return {uniform(random, -0.5, 0.5) * z, uniform(random, -0.4, 0.4) * z, z};
}

/// Image velocity of a static point by differences, px/s.
Eigen::Vector2d imageVelocity(const RowMotion& rows, const Eigen::Vector3d& point) {
    constexpr double kStep = 1e-5;  // s
    const auto pixel = [&](double time) {
        return kTallCamera.project(point + time * rows.pointVelocity(point));
    };
    return (pixel(kStep) - pixel(-kStep)) / (2 * kStep);
}

double varianceOf(const RowMotion& rows, const Eigen::Vector3d& p, const Eigen::Vector2d& normal,
                  double seconds = kSeconds) {
    const Eigen::Vector3f q = p.cast<float>();
    const Eigen::Vector2f n = normal.cast<float>();
    return static_cast<double>(
        blurVariance(cameraMotion(rows, kTallCamera, seconds), q.x(), q.y(), q.z(), n.x(), n.y()));
}

TEST(MotionBlur, IsTheSameInALargerImageOfTheSameScene) {
    PinholeCamera large = kTallCamera;
    large.width *= 3, large.height *= 3;
    large.fx *= 3, large.fy *= 3;
    std::mt19937 random(18);
    const RowMotion rows = randomRows(random);
    const Eigen::Vector3f p = randomPoint(random).cast<float>();
    const auto variance = [&](const PinholeCamera& camera) {
        return blurVariance(cameraMotion(rows, camera, kSeconds), p.x(), p.y(), p.z(), 0.6F, 0.8F);
    };
    EXPECT_NEAR(variance(large), variance(kTallCamera), 1e-5F);
}

TEST(MotionBlur, IsHowFarTheEdgeMovesAcrossItselfInThatTime) {
    std::mt19937 random(17);
    double largest = 0;
    for (int i = 0; i < 500; ++i) {
        const RowMotion rows = randomRows(random);
        const Eigen::Vector3d point = randomPoint(random);
        const Eigen::Vector2d velocity = imageVelocity(rows, point);
        const double angle = uniform(random, 0, 2 * M_PI);
        const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
        const double expected = std::pow(normal.dot(velocity) * kSeconds / sigmaAtRest(kTallCamera), 2);
        EXPECT_NEAR(varianceOf(rows, point, normal), expected, 1e-3 * expected + 1e-3);
        largest = std::max(largest, expected);
        const Eigen::Vector2d along = velocity.normalized();
        EXPECT_NEAR(varianceOf(rows, point, {-along.y(), along.x()}), 0, 1e-3) << "it moves along itself";
    }
    EXPECT_GT(largest, 20) << "these motions are fast";
}

TEST(MotionBlur, NeedsMotionAndTime) {
    std::mt19937 random(18);
    const Eigen::Vector3d point = randomPoint(random);
    EXPECT_EQ(varianceOf(RowMotion(), point, {1, 0}), 0);
    EXPECT_EQ(varianceOf(randomRows(random), point, {1, 0}, 0), 0);
}

TEST(MotionBlur, DoesNotDependOnTheUnitOfLength) {
    std::mt19937 random(19);
    for (int i = 0; i < 50; ++i) {
        RowMotion rows = randomRows(random);
        const Eigen::Vector3d point = randomPoint(random);
        const double metres = varianceOf(rows, point, {0.6, 0.8});
        rows.velocity *= 7;
        EXPECT_NEAR(varianceOf(rows, 7 * point, {0.6, 0.8}), metres, 1e-3 * metres + 1e-6);
    }
}

}  // namespace
}  // namespace roevo
