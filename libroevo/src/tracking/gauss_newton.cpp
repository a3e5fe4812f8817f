#include "roevo/tracking/gauss_newton.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace roevo {

void InformationRows::reset(std::size_t count) {
    const std::size_t padded = kernels::paddedSize(count);
    for (auto& array : matrix_) array.assign(padded, 0);
    for (auto& array : vector_) array.assign(padded, 0);
    for (auto* array : {&x_, &y_, &z_}) array->assign(padded, 0);
}

kernels::NormalEquations InformationRows::sum() const {
    kernels::PointInformation points{x_.data(), y_.data(), z_.data(), {}, {}};
    for (int a = 0; a < 6; ++a) points.matrix[a] = matrix_[a].data();
    for (int a = 0; a < 3; ++a) points.vector[a] = vector_[a].data();
    kernels::NormalEquations equations;
    kernels::best().accumulate(points, x_.size(), equations);
    return equations;
}

void PoseSystem::add(const kernels::NormalEquations& part) {
    int k = 0;
    for (int r = 0; r < 6; ++r) {
        gradient[r] += part.gradient[r];
        for (int c = r; c < 6; ++c, ++k) {
            hessian(r, c) += part.hessian[k];
            if (c != r) hessian(c, r) += part.hessian[k];
        }
    }
}

void PoseSystem::addPrior(const PosePrior& prior, const Pose& pose, double weight) {
    const Pose difference = pose * prior.mean.inverse();
    const Eigen::AngleAxisd turn(difference.linear());
    const double position = weight / (prior.sigma_translation * prior.sigma_translation);
    const double orientation = weight / (prior.sigma_rotation * prior.sigma_rotation);
    hessian.diagonal().head<3>().array() += position;
    hessian.diagonal().tail<3>().array() += orientation;
    gradient.head<3>() += position * difference.translation();
    gradient.tail<3>() += orientation * turn.angle() * turn.axis();
}

Vector6d PoseSystem::solve() const {
    const Eigen::LDLT<Matrix6d> factor(hessian);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return Vector6d::Zero();
    const Vector6d step = -factor.solve(gradient);
    return step.allFinite() ? step : Vector6d::Zero();
}

}  // namespace roevo
