// Edges lifted to three dimensions; the depth weight of Eq. (20).
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/random_pose.h"
#include "kernels/kernels.h"
#include "tracking/edge_points.h"

namespace roevo {
namespace {

const PinholeCamera kCamera{160, 120, 130, 132, 79.2, 60.4, {}};

OrganizedEdges uprightLine(float u, int first, int last) {
    OrganizedEdges edges;
    for (int v = first; v <= last; ++v) edges.addPoint(u, static_cast<float>(v), 1, 0, 10);
    edges.finishEdge();
    computeNormals(edges, 3);
    return edges;
}

EdgePoints3D lift(const OrganizedEdges& edges, const cv::Mat& depth, const PinholeCamera& camera = kCamera) {
    return liftEdges(edges, depth, camera, RowMotion(), EdgeOptions(), SensorOptions());
}

TEST(DepthWeight, IsEquation20) {
    SensorOptions sensor;
    sensor.depth_weight_k = 0.6;
    sensor.min_depth = 0.5;
    sensor.max_depth = 4.5;
    EXPECT_NEAR(depthWeight(2.5, sensor), 0.5, 1e-12);
    EXPECT_NEAR(depthWeight(3.5, sensor), 1 / (1 + std::exp(0.6)), 1e-12);
    for (double d = 0.5; d < 8; d += 0.1) EXPECT_GT(depthWeight(d, sensor), depthWeight(d + 0.1, sensor));
}

TEST(LiftEdges, PointsProjectBackOntoTheirPixels) {
    const cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(1.75F));
    const EdgePoints3D lifted = lift(uprightLine(50.25F, 20, 60), depth);
    ASSERT_EQ(lifted.size(), 41U);
    EXPECT_EQ(lifted.points.x.size(), kernels::paddedSize(41));
    EXPECT_EQ(lifted.image.numEdges(), 1);
    for (std::size_t i = 0; i < lifted.size(); ++i) {
        const Eigen::Vector2d pixel = kCamera.project(lifted.points.at(i));
        EXPECT_NEAR(pixel.x(), 50.25, 1e-4);
        EXPECT_NEAR(pixel.y(), 20 + static_cast<double>(i), 1e-4);
        EXPECT_FLOAT_EQ(lifted.points.z[i], 1.75F);
        EXPECT_FLOAT_EQ(lifted.weight[i], static_cast<float>(depthWeight(1.75, SensorOptions())));
    }
    EXPECT_FLOAT_EQ(lifted.medianDepth(), 1.75F);
    EXPECT_EQ(EdgePoints3D().medianDepth(), 0);
}

TEST(LiftEdges, SplitsWhereTheDepthJumps) {
    cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(1.5F));
    depth.rowRange(40, 120).setTo(2.5F);
    const EdgePoints3D lifted = lift(uprightLine(50, 20, 60), depth);
    ASSERT_EQ(lifted.image.numEdges(), 2);
    for (std::size_t i = 0; i < lifted.size(); ++i) {
        EXPECT_FLOAT_EQ(lifted.points.z[i], lifted.image.edge_of[i] == 0 ? 1.5F : 2.5F);
    }
}

TEST(LiftEdges, ALongHoleSplitsAndPointsInItAreGone) {
    cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(1.5F));
    depth.rowRange(35, 47).setTo(0);
    const EdgePoints3D lifted = lift(uprightLine(50, 20, 60), depth);
    EXPECT_EQ(lifted.image.numEdges(), 2);
    for (std::size_t i = 0; i < lifted.size(); ++i)
        EXPECT_TRUE(lifted.image.y[i] < 37 || lifted.image.y[i] > 44);
    EXPECT_EQ(lifted.image.normal_x.size(), lifted.size());
}

TEST(LiftEdges, NoDepthLeavesNothing) {
    const EdgePoints3D lifted = lift(uprightLine(50, 20, 60), cv::Mat::zeros(120, 160, CV_32FC1));
    EXPECT_EQ(lifted.size(), 0U);
    EXPECT_EQ(lifted.image.numEdges(), 0);
}

TEST(LiftEdges, DepthIsLookedUpWhereTheLensSawIt) {
    PinholeCamera camera = kCamera;
    camera.distortion = {0.3, 0, 0, 0, 0};
    const Eigen::Vector2d seen = camera.distortPixel({20, 60});
    ASSERT_GT(std::abs(seen.x() - 20), 3);
    cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(4.0F));
    const int column = static_cast<int>(std::lround(seen.x()));
    depth.colRange(column - 3, column + 4).setTo(1.0F);  // what the lens sees there
    const EdgePoints3D lifted = lift(uprightLine(20, 56, 64), depth, camera);
    ASSERT_GT(lifted.size(), 5U);
    for (std::size_t i = 0; i < lifted.size(); ++i) EXPECT_FLOAT_EQ(lifted.points.z[i], 1.0F);
}

TEST(LiftEdges, RowsAreBroughtToTheReferenceRow) {
    const cv::Mat depth(120, 160, CV_32FC1, cv::Scalar(2.0F));
    RowMotion rows;
    rows.velocity = {0.5, 0, 0};
    rows.seconds_per_row = 1e-3;
    rows.reference_row = 40;
    const EdgePoints3D lifted =
        liftEdges(uprightLine(50, 20, 60), depth, kCamera, rows, EdgeOptions(), SensorOptions());
    ASSERT_EQ(lifted.size(), 41U);
    // Ten rows later the camera is 5 mm further to the right, so the point lay 5 mm further right of it at
    // the time of the reference row
    const double still = kCamera.backProject(50, 50, 2).x();
    EXPECT_NEAR(lifted.points.x[30], still + 10 * 1e-3 * 0.5, 1e-5);
    EXPECT_NEAR(lifted.points.x[20], still, 1e-5);
}

}  // namespace
}  // namespace roevo
