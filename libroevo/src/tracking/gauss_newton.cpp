#include "roevo/tracking/gauss_newton.h"

#include <Eigen/Cholesky>

namespace roevo {

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

void PoseSystem::addPrior(double sigma_translation, double sigma_rotation) {
    hessian.diagonal().head<3>().array() += 1 / (sigma_translation * sigma_translation);
    hessian.diagonal().tail<3>().array() += 1 / (sigma_rotation * sigma_rotation);
}

Vector6d PoseSystem::solve() const {
    const Eigen::LDLT<Matrix6d> factor(hessian);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return Vector6d::Zero();
    const Vector6d step = -factor.solve(gradient);
    return step.allFinite() ? step : Vector6d::Zero();
}

}  // namespace roevo
