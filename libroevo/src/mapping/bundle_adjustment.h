#pragma once
#include <vector>

#include "mapping/window_equations.h"

namespace roevo {

/// What is known of a keyframe's pose relative to another's besides the edges: it decides in directions that
/// the edges hardly see.
struct RelativePrior {
    int from = 0, to = 0;  ///< window slots
    Pose T_from_to = Pose::Identity();
    Matrix6d information = Matrix6d::Zero();  ///< of the perturbation (t, phi) of T_world_to, world axes
    double weight = 1;                        ///< by which the information is less than what is known

    /// @param information  along the axes of `to`
    static RelativePrior between(const std::vector<WindowKeyframe>& window, int from, int to,
                                 const Pose& T_from_to, const Matrix6d& information, double weight);

    /// How the centre of T_world_to moves with a perturbation about `origin`: by t + phi x (centre - origin).
    Matrix6d toCentre(const std::vector<WindowKeyframe>& window, const Eigen::Vector3d& origin) const;
};

/// Bundle adjustment over a window (Eqs. (17)-(19)). Both ways alternate edge fitting and pose optimisation:
/// - alternating: each pose is registered to the fused edges as they are (the paper's Eq. (19));
/// - joint: the poses move together, with the fused points eliminated (Schur complement), which converges in
///   fewer rounds.
class BundleAdjuster {
  public:
    BundleAdjuster(const MappingOptions& mapping, const SensorOptions& sensor, const PinholeCamera& camera,
                   std::size_t hessian_points = kHessianPoints);

    /// Moves the poses of the window (those not fixed) and the points of `edges`, for at most `iterations`.
    /// @param first_scale  least spread (px) that the first iteration allows; halved in each that follows
    /// @return iterations that moved poses
    int refine(std::vector<WindowKeyframe>& window, FusedEdges& edges,
               const std::vector<RelativePrior>& priors, int iterations, double first_scale = 0);

    /// Those of the last iteration of refine(), with the priors: at the poses before its step, which is small
    /// where that ended the refinement.
    const WindowEquations& equations() const { return equations_; }

  private:
    /// The largest motion, px.
    double move(std::vector<WindowKeyframe>& window, const Eigen::VectorXd& step) const;

    double focal_length_;
    WindowEquations equations_;
};

}  // namespace roevo
