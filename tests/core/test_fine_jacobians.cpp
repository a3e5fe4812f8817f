// Jacobians of fine tracking (the paper's appendix) against numeric differences, through the code that the
// tracker uses: liftInformation and the accumulate kernel.
#include <gtest/gtest.h>

#include "core/support/random_pose.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/gauss_newton.h"
#include "tracking/photometric.h"

namespace roevo {
namespace {

using testing::uniform;

const PinholeCamera kCamera{640, 480, 517.3, 530.1, 318.6, 255.3, {}};

/// One point in one block of lanes, the rest carries nothing.
class OnePoint {
  public:
    OnePoint(const Eigen::Vector3d& p, const float matrix[6], const float vector[3]) {
        x_[0] = static_cast<float>(p.x());
        y_[0] = static_cast<float>(p.y());
        z_[0] = static_cast<float>(p.z());
        for (int k = 0; k < 6; ++k) matrix_[k][0] = matrix[k];
        for (int k = 0; k < 3; ++k) vector_[k][0] = vector[k];
    }
    PoseSystem system() {
        kernels::InformationArrays rows{x_, y_, z_, {}, {}};
        for (int k = 0; k < 6; ++k) rows.matrix[k] = matrix_[k];
        for (int k = 0; k < 3; ++k) rows.vector[k] = vector_[k];
        kernels::NormalEquations equations;
        kernels::best().accumulate(rows, kernels::kLanes, equations);
        PoseSystem system;
        system.add(equations);
        return system;
    }

  private:
    float x_[8] = {}, y_[8] = {}, z_[8] = {}, matrix_[6][8] = {}, vector_[3][8] = {};
};

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
        const Eigen::Vector3d in_camera =
            kCamera.backProject(uniform(random, 0, 640), uniform(random, 0, 480), uniform(random, 0.4, 8));
        const Eigen::Vector3d in_keyframe = pose.inverse() * in_camera;
        const double angle = uniform(random, 0, 6.3);
        const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d seen =
            kCamera.project(in_camera) + Eigen::Vector2d(uniform(random, -5, 5), uniform(random, -5, 5));
        const auto residual = [&](const Pose& at) {
            return normal.dot(kCamera.project(at * in_keyframe) - seen);
        };
        const double r = residual(pose);
        float matrix[6], vector[3];
        const auto nx = static_cast<float>(normal.x()), ny = static_cast<float>(normal.y()),
                   e = static_cast<float>(r);
        liftInformation(static_cast<float>(in_camera.x()), static_cast<float>(in_camera.y()),
                        static_cast<float>(in_camera.z()), static_cast<float>(kCamera.fx),
                        static_cast<float>(kCamera.fy), nx * nx, nx * ny, ny * ny, nx * e, ny * e, matrix,
                        vector);
        expectNear(OnePoint(in_camera, matrix, vector).system(), numericJacobian(pose, residual), r);
    }
}

TEST(FineJacobians, DepthResidualIsDifferentiatedRight) {
    std::mt19937 random(102);
    const float matrix[6] = {0, 0, 0, 0, 0, 1};  // along the optical axis only
    for (int i = 0; i < 200; ++i) {
        const Pose pose = testing::randomPose(random, 0.5, 0.4);
        const Eigen::Vector3d in_camera(uniform(random, -2, 2), uniform(random, -2, 2),
                                        uniform(random, 0.4, 8));
        const Eigen::Vector3d in_keyframe = pose.inverse() * in_camera;
        const double measured = in_camera.z() + uniform(random, -0.1, 0.1);
        const auto residual = [&](const Pose& at) { return (at * in_keyframe).z() - measured; };
        const double r = residual(pose);
        const float vector[3] = {0, 0, static_cast<float>(r)};
        expectNear(OnePoint(in_camera, matrix, vector).system(), numericJacobian(pose, residual), r);
    }
}

// A whole small problem: Gauss-Newton on these rows finds the pose again, quadratically.
TEST(FineJacobians, GaussNewtonOnThemConverges) {
    std::mt19937 random(103);
    const Pose truth = testing::randomPose(random, 0.05, 0.05);
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector2d> normals, seen;
    for (int i = 0; i < 60; ++i) {
        points.push_back(
            kCamera.backProject(uniform(random, 50, 590), uniform(random, 50, 430), uniform(random, 1, 4)));
        const double angle = uniform(random, 0, 6.3);
        normals.emplace_back(std::cos(angle), std::sin(angle));
        seen.push_back(kCamera.project(truth * points.back()));
    }
    Pose pose = Pose::Identity();
    for (int iteration = 0; iteration < 6; ++iteration) {
        PoseSystem system;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Eigen::Vector3d p = pose * points[i];
            const auto r = static_cast<float>(normals[i].dot(kCamera.project(p) - seen[i]));
            const auto nx = static_cast<float>(normals[i].x()), ny = static_cast<float>(normals[i].y());
            float matrix[6], vector[3];
            liftInformation(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
                            static_cast<float>(kCamera.fx), static_cast<float>(kCamera.fy), nx * nx, nx * ny,
                            ny * ny, nx * r, ny * r, matrix, vector);
            const PoseSystem one = OnePoint(p, matrix, vector).system();
            system.hessian += one.hessian;
            system.gradient += one.gradient;
        }
        pose = poseIncrement(system.solve()) * pose;
    }
    EXPECT_LT((pose.matrix() - truth.matrix()).norm(), 1e-5);
}

}  // namespace
}  // namespace roevo
