#pragma once
#include <cstddef>
#include <vector>

#include "roevo/tracking/kernels.h"
#include "roevo/types.h"

namespace roevo {

/// What is known of a pose before looking: a Gaussian about `mean`, in the left perturbation (t, phi).
struct PosePrior {
    Pose mean = Pose::Identity();
    double sigma_translation = 1;  ///< m
    double sigma_rotation = 1;     ///< rad
};

/// What points contribute to the normal equations, laid out as the kernels want it. Keeps its memory.
class InformationRows {
  public:
    /// All of `count` points contribute nothing until they are set.
    void reset(std::size_t count);
    /// @param matrix,vector  as in kernels::PointInformation, of a point at (x, y, z), m
    void set(std::size_t point, const float (&matrix)[6], const float (&vector)[3], float x, float y,
             float z) {
        for (int a = 0; a < 6; ++a) matrix_[a][point] = matrix[a];
        for (int a = 0; a < 3; ++a) vector_[a][point] = vector[a];
        x_[point] = x;
        y_[point] = y;
        z_[point] = z;
    }
    kernels::NormalEquations sum() const;

  private:
    std::vector<float> matrix_[6], vector_[3], x_, y_, z_;
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
