// Depth at an edge from the surfaces on both its sides.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "edges/edge_depth.h"
#include "edges/edge_sides.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace roevo {
namespace {

const PinholeCamera kSmallCamera{200, 160, 180, 180, 99.5, 79.5, {}};

/// A straight edge through the image's middle, its image, and what is found along it.
class EdgeSidesTest : public ::testing::Test {
  protected:
    /// @param degrees  direction of the edge's normal
    void drawEdge(double degrees) {
        normal_ = {std::cos(degrees * kDegree), std::sin(degrees * kDegree)};
        const Eigen::Vector2d along(-normal_.y(), normal_.x());
        edges_ = OrganizedEdges();
        for (int i = -40; i <= 40; ++i) {
            const Eigen::Vector2d p = Eigen::Vector2d(99.7, 79.6) + i * along;
            edges_.addPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(normal_.x()), static_cast<float>(normal_.y()), 30);
        }
        edges_.finishEdge();
        computeNormals(edges_, 4);
    }

    double distanceFromEdge(double u, double v) const {
        return normal_.dot(Eigen::Vector2d(u - 99.7, v - 79.6));
    }

    /// @param depthAt  depth at a distance (px) from the edge and a height in the image
    /// @param noise    one sigma, relative
    void drawDepth(const std::function<double(double, double)>& depthAt, double noise = 0) {
        std::normal_distribution<double> error(0, 1);
        depth_.create(kSmallCamera.height, kSmallCamera.width, CV_32FC1);
        for (int v = 0; v < kSmallCamera.height; ++v) {
            for (int u = 0; u < kSmallCamera.width; ++u)
                depth_.at<float>(v, u) =
                    static_cast<float>(depthAt(distanceFromEdge(u, v), v) * (1 + noise * error(random_)));
        }
    }

    /// Where the lens puts the edge's points.
    std::vector<Eigen::Vector2d> pixels(const PinholeCamera& lens = kSmallCamera) const {
        std::vector<Eigen::Vector2d> seen;
        for (std::size_t i = 0; i < edges_.size(); ++i)
            seen.push_back(lens.distortPixel({edges_.x[i], edges_.y[i]}));
        return seen;
    }
    std::vector<float> patches(const PinholeCamera& lens = kSmallCamera) const {
        const ForegroundDepth foreground(depth_, EdgeOptions(), SensorOptions());
        std::vector<float> z;
        for (const Eigen::Vector2d& p : pixels(lens))
            z.push_back(foreground.at(static_cast<float>(p.x()), static_cast<float>(p.y())));
        return z;
    }
    void correct(std::vector<float>& z, const PinholeCamera& lens = kSmallCamera) {
        correctBySides(edges_, 0, pixels(lens), depth_, static_cast<float>(EdgeOptions().depth_jump), 1, z);
    }
    std::vector<float> corrected() {
        std::vector<float> z = patches();
        correct(z);
        return z;
    }
    /// Root mean square, relative, of a step's or a bend's depth along the edge.
    double errorOf(const std::vector<float>& z, const std::function<double(double, double)>& depthAt) const {
        double sum = 0;
        for (std::size_t i = 0; i < z.size(); ++i) {
            const double truth = depthAt(0, static_cast<double>(edges_.y[i]));
            sum += std::pow(static_cast<double>(z[i]) / truth - 1, 2);
        }
        return std::sqrt(sum / static_cast<double>(z.size()));
    }

    double meanErrorOf(const std::vector<float>& z,
                       const std::function<double(double, double)>& depthAt) const {
        double sum = 0;
        for (std::size_t i = 0; i < z.size(); ++i)
            sum += static_cast<double>(z[i]) / depthAt(0, static_cast<double>(edges_.y[i])) - 1;
        return sum / static_cast<double>(z.size());
    }

    Eigen::Vector2d normal_{1, 0};
    OrganizedEdges edges_;
    cv::Mat depth_;
    std::mt19937 random_{53};
};

double wall(double, double v) {
    return 1 / (0.4 + 2e-4 * v);
}
/// Stands out from the wall by 1.5 % of the depth: below depth_jump, so that a patch does not cut there.
double frameOnWall(double distance, double v) {
    return distance <= 0 ? wall(0, v) : wall(0, v) * 1.015;
}
/// Two faces of a box that meet at the edge, which is nearer than both.
double corner(double distance, double v) {
    return 1 / (0.4 + 2e-4 * v - (distance > 0 ? 1.5e-3 : 8e-4) * std::abs(distance));
}

TEST_F(EdgeSidesTest, AnEdgeOnAPlaneStaysWhereItIs) {
    for (const double degrees : {0.0, 30.0, 90.0, 217.0}) {
        drawEdge(degrees);
        drawDepth([](double d, double v) { return 1 / (0.4 + 1e-3 * d + 2e-4 * v); });
        const std::vector<float> before = patches(), after = corrected();
        for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 5e-5) << degrees;
    }
}

TEST_F(EdgeSidesTest, ASmallStepBelongsToTheNearerSideWhicheverThatIs) {
    for (const double degrees : {0.0, 30.0, 45.0, 90.0, 180.0, 217.0}) {
        drawEdge(degrees);
        drawDepth(frameOnWall);
        EXPECT_GT(errorOf(patches(), frameOnWall), 4e-3) << "the patch alone is in the middle";
        EXPECT_LT(errorOf(corrected(), frameOnWall), 4e-4) << degrees;
    }
}

TEST_F(EdgeSidesTest, WhereTwoFacesMeetTheEdgeIsTheirIntersection) {
    for (const double degrees : {0.0, 30.0, 90.0, 217.0}) {
        drawEdge(degrees);
        drawDepth(corner);
        EXPECT_GT(errorOf(patches(), corner), 2.5e-3) << "the patch cuts the corner";
        EXPECT_LT(errorOf(corrected(), corner), 3e-4) << degrees;
    }
}

TEST_F(EdgeSidesTest, NoiseMakesNoStepsOnAPlaneAndLeavesThoseThatAre) {
    const auto plane = [](double, double v) { return wall(0, v); };
    constexpr double kNoise = 5e-3;  // as a Kinect's at 2.5 m
    double plane_before = 0, plane_after = 0, step_before = 0, step_after = 0;
    constexpr int kRepeats = 20;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        drawEdge(17.0 * repeat);
        drawDepth(plane, kNoise);
        plane_before += errorOf(patches(), plane) / kRepeats;
        plane_after += errorOf(corrected(), plane) / kRepeats;
        drawDepth(frameOnWall, kNoise);
        step_before += errorOf(patches(), frameOnWall) / kRepeats;
        step_after += errorOf(corrected(), frameOnWall) / kRepeats;
    }
    EXPECT_LT(plane_after, 1.3 * plane_before) << plane_before;
    EXPECT_LT(step_after, 0.5 * step_before) << step_before;
}

TEST_F(EdgeSidesTest, WithoutTheOtherSideOrWithoutDepthNothingIsChanged) {
    drawEdge(0);
    drawDepth(frameOnWall, 5e-3);
    depth_.colRange(100, 200).setTo(0);  // a depth camera's shadow beside the step
    const std::vector<float> before = patches();
    EXPECT_EQ(corrected(), before);
    depth_.colRange(100, 200).setTo(INFINITY);  // another way to say so
    EXPECT_EQ(corrected(), before);
    drawDepth(frameOnWall);
    std::vector<float> z = patches();
    z[10] = z[11] = 0;
    correct(z);
    EXPECT_EQ(z[10], 0);
    EXPECT_EQ(z[11], 0);
    EXPECT_NEAR(z[12], frameOnWall(0, static_cast<double>(edges_.y[12])), 1e-3);
}

TEST_F(EdgeSidesTest, WhatLiesBeyondAJumpIsNotASide) {
    const auto table = [](double distance, double) { return distance < 0 ? 1.5 : 2.5; };
    drawEdge(0);
    drawDepth(table);
    for (const float z : corrected()) EXPECT_EQ(z, 1.5F);
}

/// A surface that recedes to its border, well in front of a wall.
double receding(double distance, double) {
    return distance <= 0 ? 1 / (0.45 - 2.5e-3 * distance) : 4.0;
}

TEST_F(EdgeSidesTest, ABorderThatTheSensorSmearsIsFoundByTheSurfaceInside) {
    // Too near all along, which nothing that averages over points or frames would take away
    double before = 0, after = 0;
    constexpr int kRepeats = 40;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        drawEdge(19.0 * repeat);
        std::normal_distribution<double> smear(0, 0.8);  // px
        // A pixel shows what is seen next to it, where that is another surface
        drawDepth(
            [&](double distance, double v) {
                const double other = distance + smear(random_);
                return receding((other > 0) == (distance > 0) ? distance : other, v);
            },
            4e-3);
        before += meanErrorOf(patches(), receding) / kRepeats;
        after += meanErrorOf(corrected(), receding) / kRepeats;
    }
    EXPECT_LT(before, -1e-3) << "the smear is what makes patches too near";
    EXPECT_LT(std::abs(after), 0.6 * std::abs(before)) << before;
}

TEST_F(EdgeSidesTest, ANarrowFaceAtABorderIsNotMistakenForTheOneBehindIt) {
    // The side of a door's jamb, five pixels wide, recedes to its border; then comes its front
    const auto jamb = [](double distance, double) {
        if (distance > 0) return 4.0;
        return 1 / (0.4 - 6e-3 * std::max(distance, -5.0));
    };
    for (const double degrees : {0.0, 30.0, 90.0, 217.0}) {
        drawEdge(degrees);
        drawDepth(jamb);
        EXPECT_LT(errorOf(corrected(), jamb), 2e-3) << degrees;
    }
}

TEST_F(EdgeSidesTest, StaysFiniteOnWhateverTheDepthImageHolds) {
    std::uniform_real_distribution<float> any(0.2F, 9);
    const float odd[] = {0, NAN, INFINITY, -1};
    for (int repeat = 0; repeat < 20; ++repeat) {
        drawEdge(40.0 * repeat);
        drawDepth(wall, 0.02);
        for (int i = 0; i < 8000; ++i) {
            float& pixel =
                depth_.at<float>(static_cast<int>(random_() % 160), static_cast<int>(random_() % 200));
            pixel = i % 2 == 0 ? any(random_) : odd[random_() % 4];
        }
        const std::vector<float> before = patches(), after = corrected();
        const double jump = EdgeOptions().depth_jump;
        for (std::size_t i = 0; i < after.size(); ++i) {
            ASSERT_TRUE(std::isfinite(after[i]));
            EXPECT_LE(std::abs(static_cast<double>(before[i]) - static_cast<double>(after[i])),
                      1.05 * jump * static_cast<double>(after[i]));
        }
    }
}

TEST_F(EdgeSidesTest, FollowsALensThatDistorts) {
    // The edge is straight in ideal pixels; what the camera saw is bent
    PinholeCamera lens = kSmallCamera;
    lens.distortion = {0.2, -0.1, 0, 0, 0};
    drawEdge(0);
    depth_.create(kSmallCamera.height, kSmallCamera.width, CV_32FC1);
    for (int v = 0; v < kSmallCamera.height; ++v) {
        // The step runs where the lens puts the edge's column
        const double seen = lens.distortPixel({99.7, static_cast<double>(v)}).x();
        for (int u = 0; u < kSmallCamera.width; ++u)
            depth_.at<float>(v, u) = static_cast<float>(frameOnWall(u - seen, v));
    }
    std::vector<float> z = patches(lens);
    correct(z, lens);
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double v = lens.distortPixel({edges_.x[i], edges_.y[i]}).y();
        EXPECT_NEAR(z[i] / frameOnWall(0, v), 1, 1e-3) << i;
    }
}

}  // namespace
}  // namespace roevo
