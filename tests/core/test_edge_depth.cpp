// Foreground depth at an edge.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/support/sparse_depth.h"
#include "edges/edge_depth.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {
namespace {

const PinholeCamera kCamera{100, 80, 90, 90, 49.5, 39.5, {}};

using testing::everyNth;

float at(const cv::Mat& depth, float u, float v) {
    return ForegroundDepth(depth, EdgeOptions(), SensorOptions()).at(u, v);
}

TEST(EdgeDepth, OccludingStepGivesTheForegroundOnBothSides) {
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(3.0F));
    depth.colRange(0, 50).setTo(1.5F);
    for (const float u : {48.0F, 49.0F, 49.5F, 50.0F, 51.0F}) {
        const float found = at(depth, u, 40.3F);
        EXPECT_FLOAT_EQ(found, 1.5F) << u;
    }
    EXPECT_FLOAT_EQ(at(depth, 60, 40), 3);
}

TEST(EdgeDepth, NoneWhereTheLensLeadsOutOfTheImage) {
    const cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(3.0F));
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float out :
         {-1000.0F, 1e9F, 1e30F, -1e30F, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(at(depth, out, 40), 0) << out;
        EXPECT_EQ(at(depth, 50, out), 0) << out;
    }
}

TEST(EdgeDepth, SlantedPlaneIsExactBetweenPixels) {
    std::mt19937 random(51);
    std::uniform_real_distribution<float> slope(-0.4F, 0.4F), fraction(-0.5F, 0.5F);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const Eigen::Vector3d n(slope(random), slope(random), 1);
        cv::Mat depth(80, 100, CV_32FC1);
        const auto planeDepth = [&](double u, double v) { return 2 / n.dot(kCamera.backProject(u, v, 1)); };
        for (int v = 0; v < 80; ++v) {
            for (int u = 0; u < 100; ++u) depth.at<float>(v, u) = static_cast<float>(planeDepth(u, v));
        }
        const float u = 50 + fraction(random), v = 40 + fraction(random);
        EXPECT_NEAR(at(depth, u, v), planeDepth(static_cast<double>(u), static_cast<double>(v)), 2e-6);
    }
}

TEST(EdgeDepth, AmongItsSamplesItStaysWithinTheirRange) {
    std::mt19937 random(52);
    std::uniform_real_distribution<float> value(1.0F, 1.04F), place(3, 76);
    cv::Mat depth(80, 100, CV_32FC1);
    for (int v = 0; v < 80; ++v) {
        for (int u = 0; u < 100; ++u) depth.at<float>(v, u) = value(random);
    }
    for (int i = 0; i < 500; ++i) {
        const float z = at(depth, place(random), place(random));
        EXPECT_GE(z, 1.0F);
        EXPECT_LE(z, 1.04F);
    }
}

TEST(EdgeDepth, BesideItsSamplesItGoesNoFartherThanTheirRangeIsLong) {
    std::mt19937 random(54);
    std::uniform_real_distribution<float> value(1.0F, 1.02F), place(50, 51.4F);
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(0));
    int outside = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        float nearest = 9, farthest = 0;
        const float u = place(random);
        const int seen = static_cast<int>(std::lround(u)) - 2;  // the first column of the patch
        for (int v = 38; v <= 42; ++v) {
            for (int x = 0; x < 50; ++x) depth.at<float>(v, x) = value(random);
            for (int x = seen; x < 50; ++x) {
                nearest = std::min(nearest, depth.at<float>(v, x));
                farthest = std::max(farthest, depth.at<float>(v, x));
            }
        }
        const float z = at(depth, u, 40), range = farthest - nearest;
        EXPECT_GE(z, nearest - range);
        EXPECT_LE(z, farthest + range);
        outside += z < nearest || z > farthest ? 1 : 0;
    }
    EXPECT_GT(outside, 10) << "else nothing was tried";
}

TEST(EdgeDepth, TheFarEdgeOfWhatRecedesIsWhereItEndsNotAtItsLastSample) {
    // A wall that recedes to the right ends between columns 49 and 50, in front of another one
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(4.0F));
    const auto receding = [](float u) { return 1 / (0.5F - 2e-3F * (u - 50)); };
    for (int v = 0; v < 80; ++v) {
        for (int u = 0; u < 50; ++u) depth.at<float>(v, u) = receding(static_cast<float>(u));
    }
    for (const float u : {49.0F, 49.3F, 49.5F, 49.8F, 50.0F}) {
        const float found = at(depth, u, 40.2F);
        EXPECT_NEAR(found, receding(u), 1e-4F) << u;
        EXPECT_GT(found, receding(48)) << "it is a plane, not a mean";
    }
}

TEST(EdgeDepth, SpeckleInFrontIsIgnored) {
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(2.0F));
    depth.at<float>(40, 50) = 0.5F;
    EXPECT_FLOAT_EQ(at(depth, 50, 40), 2);
    depth.at<float>(40, 51) = 0.9F;  // a second, at another depth
    EXPECT_FLOAT_EQ(at(depth, 50, 40), 2);
}

TEST(EdgeDepth, NothingValidGivesZero) {
    for (const float bad :
         {0.0F, -1.0F, 0.05F, 50.0F, std::numeric_limits<float>::quiet_NaN(),
          std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
        const cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(static_cast<double>(bad)));
        EXPECT_EQ(at(depth, 50, 40), 0) << bad;
    }
}

TEST(EdgeDepth, InvalidNeighboursDoNotMatter) {
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(1.25F));
    depth.at<float>(39, 49) = std::numeric_limits<float>::quiet_NaN();
    depth.at<float>(40, 50) = std::numeric_limits<float>::infinity();
    depth.at<float>(41, 50) = 0;
    depth.at<float>(41, 51) = -3;
    EXPECT_FLOAT_EQ(at(depth, 50, 40), 1.25F);
}

TEST(EdgeDepth, SparseDepthIsLookedForInWiderSquares) {
    cv::Mat depth(80, 100, CV_32FC1);
    const auto slanted = [](float u, float v) { return 1 / (0.5F - 1e-3F * (u - 50) + 5e-4F * (v - 40)); };
    for (int v = 0; v < 80; ++v)
        for (int u = 0; u < 100; ++u)
            depth.at<float>(v, u) = slanted(static_cast<float>(u), static_cast<float>(v));
    for (const int n : {2, 3, 4}) {
        for (int first = 0; first < n; ++first) {
            const cv::Mat sparse = everyNth(depth, n, first);
            for (float u = 40; u < 50; u += 0.7F) {
                const float v = 38 + 0.4F * (u - 40);
                EXPECT_NEAR(at(sparse, u, v), slanted(u, v), n < 4 ? 1e-5F : 3e-3F)
                    << n << " " << first << " " << u;
            }
        }
    }
}

TEST(EdgeDepth, SparseDepthOfAStepIsThatOfTheForeground) {
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(3.0F));
    depth.colRange(0, 50).setTo(1.5F);
    for (int first = 0; first < 4; ++first) {
        const cv::Mat sparse = everyNth(depth, 4, first);
        for (const float u : {48.0F, 49.0F, 50.0F}) EXPECT_FLOAT_EQ(at(sparse, u, 40.3F), 1.5F) << u;
        EXPECT_FLOAT_EQ(at(sparse, 60, 40), 3);
        for (const float u : {0.0F, 99.0F}) EXPECT_GT(at(sparse, u, 0), 0) << u;
        EXPECT_EQ(at(sparse, -20, 40), 0);
        EXPECT_EQ(at(sparse, 1e9F, -1e9F), 0);
    }
}

TEST(EdgeDepth, HolesInDenseDepthDoNotWidenTheSquares) {
    std::mt19937 random(55);
    std::bernoulli_distribution known(0.6);
    cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(2.0F));
    depth.col(55).setTo(1);
    for (int v = 0; v < 80; ++v)
        for (int u = 0; u < 100; ++u)
            if (!known(random)) depth.at<float>(v, u) = 0;
    for (int v = 30; v < 40; ++v) EXPECT_FLOAT_EQ(at(depth, 52, static_cast<float>(v)), 2) << v;
    depth.setTo(0);
    depth(cv::Rect(60, 50, 20, 20)).setTo(1);  // a scrap of it
    EXPECT_FLOAT_EQ(at(depth, 61, 55), 1);
    EXPECT_EQ(at(depth, 57, 55), 0);
    EXPECT_EQ(at(cv::Mat(), 50, 40), 0);
    EXPECT_EQ(ForegroundDepth().at(50, 40), 0);
}

TEST(EdgeDepth, BordersAndOutsideAreSafe) {
    const cv::Mat depth(80, 100, CV_32FC1, cv::Scalar(1.25F));
    for (const float u : {0.0F, 0.4F, 99.0F}) {
        for (const float v : {0.0F, 79.0F}) EXPECT_FLOAT_EQ(at(depth, u, v), 1.25F);
    }
    // A lens may put an ideal pixel outside the raw image
    EXPECT_EQ(at(depth, -20, 40), 0);
    EXPECT_EQ(at(depth, 50, 120), 0);
}

}  // namespace
}  // namespace roevo
