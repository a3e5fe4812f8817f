#pragma once
#include "roevo/tracking/kernels.h"
#include "roevo/types.h"

namespace roevo {

/// What is known of a pose before looking: a Gaussian about `mean`, in the left perturbation (t, phi).
struct PosePrior {
    Pose mean = Pose::Identity();
    double sigma_translation = 1;  ///< m
    double sigma_rotation = 1;     ///< rad
};

/// Symmetric 6x6 system H xi = -g of Eqs. (12), (13), in double precision.
struct PoseSystem {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();

    void add(const kernels::NormalEquations& part);
    /// Keeps directions solvable that the edges do not see.
    /// @param weight  how much the rest of the system overstates its information
    void addPrior(const PosePrior& prior, const Pose& pose, double weight = 1);
    /// The Gauss-Newton step (t, phi); zero when the system is not usable.
    Vector6d solve() const;
};

}  // namespace roevo
