#include "mapping/bundle_adjustment.h"

#include <algorithm>

#include "tracking/relative_pose.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kLeastStep = 0.005;  ///< px of image motion; smaller steps end the refinement

/// Adds the error of T_world_to against T_world_from * T_from_to, as a perturbation in the world's axes.
void addPrior(const RelativePrior& prior, const std::vector<WindowKeyframe>& window,
              WindowEquations& equations) {
    const Pose& T_world_to = at(window, prior.to).T_world_camera;
    const Pose expected = at(window, prior.from).T_world_camera * prior.T_from_to;
    const Eigen::Matrix3d turned = T_world_to.linear() * expected.linear().transpose();
    const Eigen::AngleAxisd angle(turned);
    Vector6d error;
    error << T_world_to.translation() - expected.translation(), angle.angle() * angle.axis();
    const Matrix6d to_centre = prior.toCentre(window, equations.origin());
    const Matrix6d own = to_centre.transpose() * prior.information * to_centre;
    const Vector6d own_gradient = to_centre.transpose() * prior.information * error;
    const int row = equations.row(prior.from), col = equations.row(prior.to);
    if (col >= 0) equations.gradient.segment<6>(col) += own_gradient;
    if (row >= 0) equations.gradient.segment<6>(row) -= own_gradient;
    equations.add(prior.to, prior.to, own);
    equations.add(prior.from, prior.from, own);
    equations.add(std::min(prior.from, prior.to), std::max(prior.from, prior.to), -own);
}

}  // namespace

RelativePrior RelativePrior::between(const std::vector<WindowKeyframe>& window, int from, int to,
                                     const Pose& T_from_to, const Matrix6d& information, double weight) {
    const Matrix6d to_world = turnedBy(at(window, to).T_world_camera.linear());
    return {from, to, T_from_to, weight * to_world * information * to_world.transpose(), weight};
}

Matrix6d RelativePrior::toCentre(const std::vector<WindowKeyframe>& window,
                                 const Eigen::Vector3d& origin) const {
    Matrix6d to_centre = Matrix6d::Identity();
    to_centre.topRightCorner<3, 3>() = -skew(at(window, to).T_world_camera.translation() - origin);
    return to_centre;
}

BundleAdjuster::BundleAdjuster(const MappingOptions& mapping, const SensorOptions& sensor,
                               const PinholeCamera& camera, std::size_t hessian_points)
    : focal_length_(camera.fx), equations_(mapping, sensor, camera, hessian_points) {}

int BundleAdjuster::refine(std::vector<WindowKeyframe>& window, FusedEdges& edges,
                           const std::vector<RelativePrior>& priors, int iterations, double first_scale) {
    int moved = 0;
    equations_.gather(window, edges);
    if (iterations <= 0) equations_.evaluate(window, edges.points, first_scale);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        // Wide at first where old and new keyframes may have drifted apart
        equations_.evaluate(window, edges.points, first_scale / (1 << std::min(iteration, 10)));
        equations_.build(window, edges.points);
        if (equations_.numRows() == 0) continue;  // all poses are fixed: only the points are fitted
        for (const RelativePrior& prior : priors) addPrior(prior, window, equations_);
        equations_.addDamping(5e-6);
        const Eigen::VectorXd step = equations_.step();
        if (!step.allFinite()) break;
        ++moved;
        if (move(window, step) < kLeastStep) break;
    }
    return moved;
}

double BundleAdjuster::move(std::vector<WindowKeyframe>& window, const Eigen::VectorXd& step) const {
    double largest = 0;
    for (std::size_t s = 0; s < window.size(); ++s) {
        const int row = equations_.row(s);
        if (row < 0) continue;
        const Vector6d xi = step.segment<6>(row);
        const Pose before = window[s].T_world_camera;
        Pose T_origin_camera = before;
        T_origin_camera.translation() -= equations_.origin();
        window[s].T_world_camera = poseIncrement(xi) * T_origin_camera;
        window[s].T_world_camera.translation() += equations_.origin();
        const double moved = (window[s].T_world_camera.translation() - before.translation()).norm() /
                                 window[s].keyframe->typicalDepth() +
                             xi.tail<3>().norm();
        largest = std::max(largest, focal_length_ * moved);
    }
    return largest;
}

}  // namespace roevo
