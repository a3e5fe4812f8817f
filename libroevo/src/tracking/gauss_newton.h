#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "kernels/kernels.h"
#include "roevo/types.h"
#include "tracking/edge_clusters.h"
#include "tracking/points3.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// What is known of a pose before looking: a Gaussian about `mean`, in the left perturbation (t, phi).
struct PosePrior {
    Pose mean = Pose::Identity();
    Matrix6d covariance = Matrix6d::Identity();
    double weight = 1;  ///< by how much the rest of the system overstates its information
    /// What is not known of a pose at the mean: of the pose before it, and of the motion since.
    PoseUncertainty errors = {};
};

/// What points contribute to the normal equations, laid out as the kernels want it. Keeps its memory.
class InformationRows {
  public:
    /// Room for `count` points and the padding, all of which are to be written.
    kernels::InformationArrays arrays(std::size_t count);
    kernels::NormalEquations sum();
    /// Multiplies what each point contributes by a factor of its own (padded).
    void scale(const std::vector<float>& factors);
    /// Adds each of them to its edge; none before anything was set.
    /// @param edge_of(point)  index of its edge, -1 for none
    template <class EdgeOf>
    void addTo(EdgeClusters& clusters, std::size_t count, EdgeOf&& edge_of) const {
        for (std::size_t i = 0; i < std::min(count, points_.size()); ++i) {
            float matrix[6], vector[3];
            for (int a = 0; a < 6; ++a) matrix[a] = matrix_[a][i];
            for (int a = 0; a < 3; ++a) vector[a] = vector_[a][i];
            if (matrix[0] + matrix[3] + matrix[5] > 0)
                clusters.add(static_cast<std::size_t>(edge_of(i)), matrix, vector, points_.at(i));
        }
    }

  private:
    std::vector<float> matrix_[6], vector_[3];
    Points3 points_;
};

/// Symmetric 6x6 system H xi = -g of Eqs. (12), (13), in double precision, and what joins the read-out time
/// to it where that is free.
struct PoseSystem {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    Vector6d readout_mixed = Vector6d::Zero();
    double readout_hessian = 0, readout_gradient = 0;

    void add(const kernels::NormalEquations& part);
    /// The same solution, known so many times less well.
    PoseSystem operator/(double times) const;
    /// The Gauss-Newton step (t, phi); zero when the system is not usable.
    Vector6d solve() const;
    /// The step (t, phi, seconds per row).
    Eigen::Matrix<double, 7, 1> solveWithReadout() const;
};

/// Where a term is linearised.
struct Linearisation {
    Pose T_current_keyframe = Pose::Identity();
    RowMotion rows;
    int iteration = 0;
};

/// A part of what is minimised over the pose.
class ResidualTerm {
  public:
    virtual ~ResidualTerm() = default;
    /// Adds its normal equations. @return false where too little is seen to go on
    [[nodiscard]] virtual bool linearise(const Linearisation& at, PoseSystem& system) = 0;
    /// How well the last linearisation fits, comparable between poses.
    virtual double cost() const { return 0; }
    /// Adds what each of the keyframe's edges contributed to the last linearisation.
    virtual void addTo(EdgeClusters&) const {}
    /// The last linearisation is the best so far.
    virtual void keep() {}
    /// What the term estimates besides the pose goes along with the step.
    virtual void update() {}
};

/// What is likely beforehand: keeps directions solvable that the edges do not see.
class PriorTerm : public ResidualTerm {
  public:
    explicit PriorTerm(const PosePrior& prior);
    bool linearise(const Linearisation& at, PoseSystem& system) override;
    /// With its weight.
    const Matrix6d& information() const { return information_; }
    const PoseUncertainty& errors() const { return errors_; }

  private:
    Pose mean_;
    PoseUncertainty errors_;
    Matrix6d information_;
};

/// Holds steps back: a prior about wherever the pose is.
class DampingTerm : public ResidualTerm {
  public:
    DampingTerm(double sigma_translation, double sigma_rotation)
        : sigma_translation_(sigma_translation), sigma_rotation_(sigma_rotation) {}
    bool linearise(const Linearisation& at, PoseSystem& system) override;

  private:
    double sigma_translation_, sigma_rotation_;
};

struct GaussNewtonOptions {
    int max_iterations = 1;
    double focal_length = 1;    ///< px
    double depth = 1;           ///< m, of a typical point
    int settled_from = 1;       ///< iterations from which on a small step ends it
    double still = 0.01;        ///< px of image motion: a small step
    double relaxation = 1;      ///< factor on the steps from `relaxed_from` on
    int relaxed_from = 0;       ///< iteration
    bool keep_best = false;     ///< the last pose whose cost, of the first term, is about the least counts
    bool free_readout = false;  ///< the read-out time moves, too
};

struct GaussNewtonResult {
    Pose T_current_keyframe = Pose::Identity();
    double seconds_per_row = 0;
    PoseSystem system;  ///< of the last linearisation
    double cost = -1;   ///< of the best; negative where nothing could be linearised
    int iterations = 0;
    bool complete = false;  ///< no term gave up
};

/// The one Gauss-Newton loop: coarse and fine tracking and the read-out time differ by their terms.
/// @param shutter  tells how the rows move at a pose
[[nodiscard]] GaussNewtonResult minimise(const Pose& T_start, RollingShutter shutter,
                                         const std::vector<ResidualTerm*>& terms,
                                         const GaussNewtonOptions& options);

}  // namespace roevo
