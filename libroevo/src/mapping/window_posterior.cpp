#include "mapping/window_posterior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "mapping/window_equations.h"
#include "tracking/relative_pose.h"

namespace roevo {
namespace {

/// Share of the pulls of edges at keyframes that must be left over when each pose has taken its six.
constexpr double kLeastLeft = 0.1;

using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// From a perturbation of the window to one along the camera's own axes.
Matrix6d toCamera(const Pose& T_world_camera, const Eigen::Vector3d& origin) {
    Pose T_origin_camera = T_world_camera;
    T_origin_camera.translation() -= origin;
    return carriedTo(T_origin_camera);
}

}  // namespace

std::optional<WindowPosterior> posteriorOf(const std::vector<WindowKeyframe>& window,
                                           const WindowEquations& equations,
                                           const std::vector<std::int32_t>& clusters,
                                           const std::vector<RelativePrior>& priors) {
    const int anchor = equations.anchor();
    const auto newest = static_cast<int>(window.size()) - 1;
    const int own_row = newest < 0 ? -1 : equations.row(newest);
    if (anchor < 1 || own_row < 0) return std::nullopt;
    const auto unknowns = static_cast<double>(equations.numRows());
    const auto pulls = static_cast<double>(equations.pulls().size());
    if (pulls - unknowns < kLeastLeft * pulls) return std::nullopt;

    // Rows of the inverse that tell what moves the newest keyframe, along its axes
    const Eigen::LLT<Eigen::MatrixXd> factor(equations.hessian().selfadjointView<Eigen::Upper>());
    if (factor.info() != Eigen::Success) return std::nullopt;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(equations.numRows(), 6);
    columns.middleRows<6>(own_row).setIdentity();
    const Rows gain =
        toCamera(window.back().T_world_camera, equations.origin()) * factor.solve(columns).transpose();
    if (!gain.allFinite()) return std::nullopt;
    const auto moves = [&](int slot, const Matrix6d& pull) -> Matrix6d {
        const int row = equations.row(slot);
        return row < 0 ? Matrix6d::Zero() : Matrix6d(gain.middleCols<6>(row) * pull);
    };

    WindowPosterior out;
    const WindowKeyframe& oldest = at(window, anchor);
    out.oldest = oldest.keyframe->id;
    out.reused = window[0].keyframe->id;
    out.follows.setZero();
    for (int slot = anchor + 1; slot <= newest; ++slot)
        out.follows -= moves(slot, equations.anchorBlock(slot).transpose());
    for (const RelativePrior& prior : priors) {
        const Matrix6d to_centre = prior.toCentre(window, equations.origin());
        const Matrix6d information = to_centre.transpose() * prior.information * to_centre;
        if (prior.from == anchor) out.follows += moves(prior.to, information);
        // It is weighed for less than what it knows
        const Matrix6d known = information / prior.weight;
        const Matrix6d moved = moves(prior.to, information) - moves(prior.from, information);
        out.uncertainty.independent += moved * known.inverse() * moved.transpose();
    }
    out.follows = (out.follows * toCamera(oldest.T_world_camera, equations.origin()).inverse()).eval();

    std::map<std::int32_t, Vector6d> moved;
    for (const WindowEquations::EdgePull& pull : equations.pulls()) {
        const int row = equations.row(pull.slot);
        if (row < 0) continue;
        Vector6d& sum = moved.try_emplace(at(clusters, pull.edge), Vector6d::Zero()).first->second;
        sum -= gain.middleCols<6>(row) * pull.gradient;  // a step is against the gradient
    }
    const auto edges = static_cast<double>(moved.size());
    if (edges < 2) return std::nullopt;
    const double freedom = std::sqrt(pulls / (pulls - unknowns) * edges / (edges - 1));
    for (const auto& [cluster, by] : moved) out.uncertainty.influences.push_back({cluster, freedom * by});
    if (!out.uncertainty.covariance().allFinite()) return std::nullopt;
    return out;
}

}  // namespace roevo
