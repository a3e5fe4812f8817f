// Bundle adjustment against an independent solver.
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>

#include "core/support/bundle_fixture.h"
#include "mapping/window_equations.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using namespace testing;
using BundleOracle = BundleAdjustment;

/// One observation for Ceres: the pose is T_camera_world (angle-axis, translation).
struct CeresObservation {
    PinholeCamera camera;
    Eigen::Vector2d measured, normal;
    double across, along, depth,
        slope;  // factors of the two residuals; measured depth, its change along the edge

    template <class T>
    bool operator()(const T* pose, const T* point, T* residual) const {
        T q[3];
        ceres::AngleAxisRotatePoint(pose, point, q);
        for (int k = 0; k < 3; ++k) q[k] += pose[3 + k];
        const T u = camera.fx * q[0] / q[2] + camera.cx, v = camera.fy * q[1] / q[2] + camera.cy;
        residual[0] = across * (normal.x() * (u - measured.x()) + normal.y() * (v - measured.y()));
        const T further = normal.x() * (v - measured.y()) - normal.y() * (u - measured.x());
        residual[1] = along * (q[2] - depth - slope * further);
        return true;
    }
};

/// What an observation counts for, as a share of one at rest: its place across the edge is known at a time
/// that has a sigma of blur_time, and to a third of a pixel besides.
double sharpnessOf(const MapKeyframe& keyframe, std::size_t i, const SensorOptions& sensor) {
    constexpr double kStep = 1e-5;  // s
    const Eigen::Vector3d velocity = keyframe.row_motion.pointVelocity(keyframe.points.at(i));
    const Eigen::Vector2d moved = mappingCamera().project(keyframe.points.at(i) + kStep * velocity) -
                                  mappingCamera().project(keyframe.points.at(i) - kStep * velocity);
    const double speed = (moved.x() * static_cast<double>(keyframe.image.normal_x[i]) +
                          moved.y() * static_cast<double>(keyframe.image.normal_y[i])) /
                         (2 * kStep);
    return 1 / (1 + std::pow(3 * speed * sensor.blur_time, 2));
}

/// Keeps a point where it is along its edge: lines are compared, on which its place is free.
struct CeresHold {
    Eigen::Vector3d point, direction;

    template <class T>
    bool operator()(const T* at, T* residual) const {
        residual[0] = T(0);
        for (int k = 0; k < 3; ++k) residual[0] += 1e6 * direction[k] * (at[k] - point[k]);
        return true;
    }
};

using CeresPose = std::array<double, 6>;  ///< T_camera_world: angle-axis, translation

Pose fromCeres(const CeresPose& pose) {
    const Eigen::Vector3d turn(pose[0], pose[1], pose[2]);
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    return Pose(rotation, {pose[3], pose[4], pose[5]}).inverse();
}

/// The window for Ceres, from where the poses and points are now. No robust loss.
void addToProblem(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                  const MappingOptions& mapping, const SensorOptions& sensor, double scale,
                  std::vector<CeresPose>& poses, std::vector<Eigen::Vector3d>& points,
                  ceres::Problem& problem) {
    poses.resize(window.size());
    points = edges.points;
    for (std::size_t s = 0; s < window.size(); ++s) {
        const Pose T = window[s].T_world_camera.inverse();
        const Eigen::AngleAxisd turn(T.linear());
        for (int k = 0; k < 3; ++k) {
            poses[s][static_cast<std::size_t>(k)] = turn.angle() * turn.axis()[k];
            poses[s][static_cast<std::size_t>(k) + 3] = T.translation()[k];
        }
        problem.AddParameterBlock(poses[s].data(), 6);
        if (window[s].fixed) problem.SetParameterBlockConstant(poses[s].data());
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
        const auto first = static_cast<std::size_t>(edges.observation_begin[p]);
        const auto end = static_cast<std::size_t>(edges.observation_begin[p + 1]);
        if (end - first < 2) continue;
        const auto edge_end = std::upper_bound(edges.begin.begin(), edges.begin.end(), static_cast<int>(p));
        const auto low = std::max(p, static_cast<std::size_t>(*(edge_end - 1)) + 1) - 1;
        const auto high = std::min(p + 1, static_cast<std::size_t>(*edge_end) - 1);
        const Eigen::Vector3d chord = edges.points[high] - edges.points[low];
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CeresHold, 1, 3>(
                                     new CeresHold{edges.points[p], chord.normalized()}),
                                 nullptr, points[p].data());
        for (std::size_t k = first; k < end; ++k) {
            const auto slot = static_cast<std::size_t>(edges.observations[k].slot);
            const auto i = static_cast<std::size_t>(edges.observations[k].point);
            const MapKeyframe& keyframe = *window[slot].keyframe;
            const double trust =
                std::sqrt(static_cast<double>(keyframe.weight[i]) * sharpnessOf(keyframe, i, sensor));
            const double depth = keyframe.points.z[i];
            // A millimetre is the least deviation of a depth
            const double sigma = std::hypot(sensor.depth_noise * depth * depth, 1e-3);
            problem.AddResidualBlock(
                new ceres::AutoDiffCostFunction<CeresObservation, 2, 6, 3>(
                    new CeresObservation{mappingCamera(),
                                         {keyframe.image.x[i], keyframe.image.y[i]},
                                         {keyframe.image.normal_x[i], keyframe.image.normal_y[i]},
                                         trust / scale,
                                         trust * std::sqrt(mapping.depth_weight) / sigma,
                                         depth,
                                         keyframe.slope[i]}),
                nullptr, poses[slot].data(), points[p].data());
        }
    }
}

/// Camera centres of the window by Ceres.
std::vector<Eigen::Vector3d> solveWithCeres(const std::vector<WindowKeyframe>& window,
                                            const FusedEdges& edges, const MappingOptions& mapping,
                                            const SensorOptions& sensor, double scale) {
    std::vector<CeresPose> poses;
    std::vector<Eigen::Vector3d> points;
    ceres::Problem problem;
    addToProblem(window, edges, mapping, sensor, scale, poses, points, problem);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-16;
    options.gradient_tolerance = 1e-14;
    options.parameter_tolerance = 1e-14;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    EXPECT_TRUE(summary.IsSolutionUsable()) << summary.FullReport();
    std::vector<Eigen::Vector3d> centres;
    for (const CeresPose& pose : poses) centres.push_back(fromCeres(pose).translation());
    return centres;
}

/// Covariance of the newest keyframe by Ceres, along its own axes: position in m, orientation in rad.
Matrix6d covarianceByCeres(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                           const MappingOptions& mapping, const SensorOptions& sensor, double scale) {
    std::vector<CeresPose> poses;
    std::vector<Eigen::Vector3d> points;
    ceres::Problem problem;
    addToProblem(window, edges, mapping, sensor, scale, poses, points, problem);
    ceres::Covariance covariance({});
    const double* newest = poses.back().data();
    EXPECT_TRUE(covariance.Compute(std::vector<const double*>{newest}, &problem));
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> own;
    EXPECT_TRUE(covariance.GetCovarianceBlock(newest, newest, own.data()));
    constexpr double kStep = 1e-6;
    Matrix6d to_axes;
    for (int k = 0; k < 6; ++k) {
        CeresPose less = poses.back(), more = less;
        less[static_cast<std::size_t>(k)] -= kStep;
        more[static_cast<std::size_t>(k)] += kStep;
        const Pose between = fromCeres(less).inverse() * fromCeres(more);
        const Eigen::AngleAxisd angle(between.linear());
        to_axes.col(k) << between.translation(), angle.angle() * angle.axis();
    }
    to_axes /= 2 * kStep;
    return to_axes * own * to_axes.transpose();
}

TEST_F(BundleOracle, AgreesWithCeresOnNoisyKeyframes) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        SetUp();
        for (auto& made : made_) {
            MapKeyframe& keyframe = made.keyframe;
            for (int k = 0; k < 3; ++k) {
                keyframe.row_motion.velocity[k] = uniform(random, -0.2, 0.2);
                keyframe.row_motion.turn[k] = uniform(random, -0.3, 0.3);
            }
            double bias = 0;
            for (std::size_t i = 0; i < keyframe.size(); ++i) {
                // Errors of an edge go together. So small that all weights of the t-distribution are alike
                if (i == 0 || keyframe.image.edge_of[i] != keyframe.image.edge_of[i - 1])
                    bias = 0.01 * normal(random);
                const double error = bias + 0.003 * normal(random);
                keyframe.image.x[i] += static_cast<float>(error) * keyframe.image.normal_x[i];
                keyframe.image.y[i] += static_cast<float>(error) * keyframe.image.normal_y[i];
                keyframe.points.z[i] += static_cast<float>(2e-4 * normal(random));
                keyframe.weight[i] = static_cast<float>(uniform(random, 0.2, 1));
            }
        }
        // Associations are those of the true poses: false ones make residuals that weigh differently
        disturb(window_, random, kFewMillimetres, kThirdOfADegree);
        mapping_.chi2 = mapping_.depth_chi2 = 1e9;
        const double scale = refineToTheEnd(600);
        const auto centres = solveWithCeres(truth_, edges_, mapping_, sensor_, scale);
        double moved = 0, apart = 0;
        for (std::size_t s = 1; s < window_.size(); ++s) {
            const Eigen::Vector3d found = window_[s].T_world_camera.translation();
            moved = std::max(moved, (centres[s] - truth_[s].T_world_camera.translation()).norm());
            apart = std::max(apart, (centres[s] - found).norm());
        }
        EXPECT_GT(moved, 2e-5) << "the noise must matter for the comparison to mean something";
        EXPECT_LT(apart, 0.01 * moved) << "weights differ by up to 1 %";
    }
}

/// What independent errors leave of the newest pose when the points are eliminated.
TEST_F(BundleOracle, InverseOfTheEquationsIsTheCovarianceThatCeresComputes) {
    std::mt19937 random(3);
    for (auto& made : made_)
        for (float& weight : made.keyframe.weight) weight = static_cast<float>(uniform(random, 0.2, 1));
    look(std::move(made_));
    WindowEquations equations(mapping_, sensor_, mappingCamera());
    equations.gather(window_, edges_);
    equations.evaluate(window_, edges_.points, 0.5);  // far above the residuals: all weights are alike
    equations.build(window_, edges_.points);
    const Eigen::MatrixXd inverse =
        Eigen::MatrixXd(equations.hessian().selfadjointView<Eigen::Upper>()).inverse();
    // From turns about the window's origin to the camera's own axes
    const Pose& newest = window_.back().T_world_camera;
    Matrix6d to_camera = Matrix6d::Identity();
    to_camera.topRightCorner<3, 3>() = -skew(newest.translation() - equations.origin());
    Matrix6d turned = Matrix6d::Zero();
    turned.topLeftCorner<3, 3>() = turned.bottomRightCorner<3, 3>() = newest.linear().transpose();
    to_camera = turned * to_camera;
    const int row = equations.row(window_.size() - 1);
    // Weights of the t-distribution at residuals of nothing
    const double weight = (kStudentNu + 1) / kStudentNu;
    const Matrix6d own = weight * to_camera * inverse.block<6, 6>(row, row) * to_camera.transpose();
    const Matrix6d expected = covarianceByCeres(window_, edges_, mapping_, sensor_, equations.scale);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(own, expected);
    EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.97) << ratios.eigenvalues().transpose();
    EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.03) << ratios.eigenvalues().transpose();
}

}  // namespace
}  // namespace roevo
