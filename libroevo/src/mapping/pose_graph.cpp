#include "mapping/pose_graph.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include "indexing.h"
#include "tracking/relative_pose.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr int kMostGraphIterations = 20;
constexpr double kSmallStep = 1e-7;       // m and rad
constexpr double kVarianceFloor = 1e-12;  // m^2, rad^2

/// Position and orientation of `to` as the poses have it against the constraint, along its axes.
Vector6d residual(const std::vector<Pose>& poses, const PoseConstraint& c) {
    const Pose T_from_to = at(poses, c.from).inverse() * at(poses, c.to);
    const Pose error = c.T_from_to.inverse() * T_from_to;
    const Eigen::AngleAxisd turn(error.rotation());
    Vector6d out;
    // Along the axes of `to` as it is, so that steps enter with the identity
    out << error.linear().transpose() * error.translation(), turn.angle() * turn.axis();
    return out;
}

Matrix6d informationOf(const PoseConstraint& c) {
    return (c.covariance + kVarianceFloor * Matrix6d::Identity()).inverse();
}

}  // namespace

double contradiction(const std::vector<Pose>& poses, const PoseConstraint& c) {
    const Vector6d e = residual(poses, c);
    return e.dot(informationOf(c) * e);
}

bool optimisePoseGraph(std::vector<Pose>& poses, const std::vector<PoseConstraint>& constraints, int fixed) {
    const std::vector<Pose> before = poses;
    std::vector<int> rows(poses.size(), -1);
    int count = 0;
    for (const PoseConstraint& c : constraints)
        for (const int id : {c.from, c.to})
            if (id > fixed && at(rows, id) < 0) at(rows, id) = count++;
    std::vector<Matrix6d> information;
    for (const PoseConstraint& c : constraints) information.push_back(informationOf(c));
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    for (int iteration = 0; iteration < kMostGraphIterations; ++iteration) {
        std::vector<Eigen::Triplet<double>> blocks;
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * count);
        const auto add = [&](int row, int column, const Matrix6d& block) {
            for (int p = 0; row >= 0 && column >= 0 && p < 36; ++p)
                blocks.emplace_back(6 * row + p / 6, 6 * column + p % 6, block(p / 6, p % 6));
        };
        for (std::size_t k = 0; k < constraints.size(); ++k) {
            const PoseConstraint& c = constraints[k];
            const Vector6d e = residual(poses, c);
            const Pose T = at(poses, c.from).inverse() * at(poses, c.to);
            const Matrix6d from = -carriedTo(T);  // how a step of `from` changes the residual
            const int i = at(rows, c.from), j = at(rows, c.to);
            const Matrix6d& W = information[k];
            add(i, i, from.transpose() * W * from);
            add(i, j, from.transpose() * W);
            add(j, i, W * from);
            add(j, j, W);
            if (i >= 0) gradient.segment<6>(6 * i) += from.transpose() * W * e;
            if (j >= 0) gradient.segment<6>(6 * j) += W * e;
        }
        Eigen::SparseMatrix<double> hessian(6 * count, 6 * count);
        hessian.setFromTriplets(blocks.begin(), blocks.end());
        if (iteration == 0) solver.analyzePattern(hessian);
        solver.factorize(hessian);
        const Eigen::VectorXd step =
            solver.info() == Eigen::Success ? Eigen::VectorXd(solver.solve(-gradient)) : gradient;
        if (solver.info() != Eigen::Success || !step.allFinite()) {
            poses = before;
            return false;
        }
        for (std::size_t p = 0; p < poses.size(); ++p) {
            if (rows[p] < 0) continue;
            poses[p] = poses[p] * poseIncrement(step.segment<6>(6 * rows[p]));
        }
        if (step.lpNorm<Eigen::Infinity>() < kSmallStep) break;
    }
    return true;
}

}  // namespace roevo
