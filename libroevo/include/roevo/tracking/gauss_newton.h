#pragma once
#include "roevo/tracking/kernels.h"
#include "roevo/types.h"

namespace roevo {

/// Symmetric 6x6 system H xi = -g of Eqs. (12), (13), in double precision.
struct PoseSystem {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();

    void add(const kernels::NormalEquations& part);
    /// Gaussian prior on the present pose: keeps directions solvable that the edges do not see.
    void addPrior(double sigma_translation, double sigma_rotation);
    /// The Gauss-Newton step (t, phi); zero when the system is not usable.
    Vector6d solve() const;
};

}  // namespace roevo
