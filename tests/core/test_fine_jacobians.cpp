// Jacobians of fine tracking (the paper's appendix) against numeric differences, through the code that the
// tracker uses: the kernels liftEdges and accumulate.
#include <gtest/gtest.h>

#include <array>

#include "core/support/random_pose.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/gauss_newton.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kUnequalCamera{640, 480, 517.3, 530.1, 318.6, 255.3, {}};

/// What one match, of a point in the camera with an edge of this normal, adds to the system with these
/// residuals.
PoseSystem systemOf(const Eigen::Vector3d& point, const Eigen::Vector2d& normal, double tangent_residual,
                    double tangent_weight, double depth_residual, double depth_weight) {
    using Lanes = std::array<float, kernels::kLanes>;
    const auto lanes = [](double value) {
        Lanes all{};
        all.fill(static_cast<float>(value));
        return all;
    };
    const auto first = [](double value) {  // the rest carries nothing
        return Lanes{static_cast<float>(value)};
    };
    const Lanes x = lanes(point.x()), y = lanes(point.y()), z = lanes(point.z()), nx = lanes(normal.x()),
                ny = lanes(normal.y()), residual = lanes(tangent_residual), weight = first(tangent_weight),
                depth = lanes(depth_residual), of_depth = first(depth_weight);
    const std::array<std::int32_t, kernels::kLanes> current{};
    InformationRows rows;
    kernels::best().liftEdges({x.data(), y.data(), z.data(), nullptr, nullptr, current.data()},
                              {nullptr, nullptr, nx.data(), ny.data(), nullptr, nullptr}, weight.data(),
                              residual.data(), of_depth.data(), depth.data(), kernels::kLanes,
                              static_cast<float>(kUnequalCamera.fx), static_cast<float>(kUnequalCamera.fy),
                              rows.arrays(1));
    PoseSystem system;
    system.add(rows.sum());
    return system;
}

template <class Residual>
Vector6d numericJacobian(const Pose& pose, Residual&& residual) {
    Vector6d jacobian;
    for (int k = 0; k < 6; ++k) {
        Vector6d step = Vector6d::Zero();
        step[k] = 1e-5;
        jacobian[k] = (residual(poseIncrement(step) * pose) - residual(poseIncrement(-step) * pose)) / 2e-5;
    }
    return jacobian;
}

void expectNear(const PoseSystem& system, const Vector6d& jacobian, double residual) {
    const Matrix6d hessian = jacobian * jacobian.transpose();
    EXPECT_LT((system.hessian - hessian).norm(), 2e-5 * hessian.norm());
    EXPECT_LT((system.gradient - residual * jacobian).norm(),
              2e-5 * std::abs(residual) * jacobian.norm() + 1e-6);
}

TEST(FineJacobians, PointToTangentResidualIsDifferentiatedRight) {
    std::mt19937 random(101);
    for (int i = 0; i < 500; ++i) {
        const Pose pose = testing::randomPose(random, 0.5, 0.4);
        const Eigen::Vector3d in_camera = kUnequalCamera.backProject(
            uniform(random, 0, 640), uniform(random, 0, 480), uniform(random, 0.4, 8));
        const Eigen::Vector3d in_keyframe = pose.inverse() * in_camera;
        const double angle = uniform(random, 0, 6.3);
        const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d seen = kUnequalCamera.project(in_camera) +
                                     Eigen::Vector2d(uniform(random, -5, 5), uniform(random, -5, 5));
        const auto residual = [&](const Pose& at) {
            return normal.dot(kUnequalCamera.project(at * in_keyframe) - seen);
        };
        const double r = residual(pose);
        expectNear(systemOf(in_camera, normal, r, 1, 0, 0), numericJacobian(pose, residual), r);
    }
}

TEST(FineJacobians, DepthResidualIsDifferentiatedRight) {
    std::mt19937 random(102);
    constexpr double kHardly = 1e-30;  // depths of outliers do not count
    for (int i = 0; i < 200; ++i) {
        const Pose pose = testing::randomPose(random, 0.5, 0.4);
        const Eigen::Vector3d in_camera(uniform(random, -2, 2), uniform(random, -2, 2),
                                        uniform(random, 0.4, 8));
        const Eigen::Vector3d in_keyframe = pose.inverse() * in_camera;
        const double measured = in_camera.z() + uniform(random, -0.1, 0.1);
        const auto residual = [&](const Pose& at) { return (at * in_keyframe).z() - measured; };
        const double r = residual(pose);
        expectNear(systemOf(in_camera, {1, 0}, 0, kHardly, r, 1), numericJacobian(pose, residual), r);
    }
}

// A whole small problem: Gauss-Newton on these rows finds the pose again, quadratically.
TEST(FineJacobians, GaussNewtonOnThemConverges) {
    std::mt19937 random(103);
    const Pose truth = testing::randomPose(random, 0.05, 0.05);
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector2d> normals, seen;
    for (int i = 0; i < 60; ++i) {
        points.push_back(kUnequalCamera.backProject(uniform(random, 50, 590), uniform(random, 50, 430),
                                                    uniform(random, 1, 4)));
        const double angle = uniform(random, 0, 6.3);
        normals.emplace_back(std::cos(angle), std::sin(angle));
        seen.push_back(kUnequalCamera.project(truth * points.back()));
    }
    Pose pose = Pose::Identity();
    for (int iteration = 0; iteration < 6; ++iteration) {
        PoseSystem system;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Eigen::Vector3d p = pose * points[i];
            const double r = normals[i].dot(kUnequalCamera.project(p) - seen[i]);
            const PoseSystem one = systemOf(p, normals[i], r, 1, 0, 0);
            system.hessian += one.hessian;
            system.gradient += one.gradient;
        }
        pose = poseIncrement(system.solve()) * pose;
    }
    EXPECT_LT((pose.matrix() - truth.matrix()).norm(), 1e-5);
}

}  // namespace
}  // namespace roevo
