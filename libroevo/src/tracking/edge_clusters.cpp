#include "tracking/edge_clusters.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tracking/gauss_newton.h"

namespace roevo {

Matrix6d PoseUncertainty::covariance() const {
    Matrix6d sum = independent;
    for (const EdgeInfluence& edge : influences) sum.noalias() += edge.moved * edge.moved.transpose();
    return sum;
}

double PoseUncertainty::designEffect() const {
    const double effect = (covariance() * independent.inverse()).trace() / 6;
    return std::isfinite(effect) ? std::max(1.0, effect) : 1;
}

void EdgeClusters::start(const std::vector<std::int32_t>& cluster_of) {
    if (cluster_of_ != cluster_of) {  // another keyframe
        cluster_of_ = clusters_ = cluster_of;
        std::sort(clusters_.begin(), clusters_.end());
        clusters_.erase(std::unique(clusters_.begin(), clusters_.end()), clusters_.end());
        slot_of_.clear();
        for (const std::int32_t cluster : cluster_of) {
            const auto at = std::lower_bound(clusters_.begin(), clusters_.end(), cluster);
            slot_of_.push_back(static_cast<std::int32_t>(at - clusters_.begin()));
        }
    }
    sums_.assign(clusters_.size(), Sum());
}

void EdgeClusters::add(std::size_t edge, const float (&matrix)[6], const float (&vector)[3],
                       const Eigen::Vector3d& point) {
    if (edge >= slot_of_.size()) return;  // of points that are no edge points, as experiments choose them
    Sum& sum = sums_[static_cast<std::size_t>(slot_of_[edge])];
    sum.used = true;
    const double x = point.x(), y = point.y(), z = point.z();
    const double xx = matrix[0], xy = matrix[1], xz = matrix[2], yy = matrix[3], yz = matrix[4],
                 zz = matrix[5];
    // As kernels::Table::accumulate, of one point
    const double a00 = y * xz - z * xy, a01 = z * xx - x * xz, a02 = x * xy - y * xx;
    const double a10 = y * yz - z * yy, a11 = z * xy - x * yz, a12 = x * yy - y * xy;
    const double a20 = y * zz - z * yz, a21 = z * xz - x * zz, a22 = x * yz - y * xz;
    const double hessian[21] = {xx,
                                xy,
                                xz,
                                a00,
                                a01,
                                a02,
                                yy,
                                yz,
                                a10,
                                a11,
                                a12,
                                zz,
                                a20,
                                a21,
                                a22,
                                y * a20 - z * a10,
                                y * a21 - z * a11,
                                y * a22 - z * a12,
                                z * a01 - x * a21,
                                z * a02 - x * a22,
                                x * a12 - y * a02};
    const double vx = vector[0], vy = vector[1], vz = vector[2];
    const double gradient[6] = {vx, vy, vz, y * vz - z * vy, z * vx - x * vz, x * vy - y * vx};
    for (int k = 0; k < 21; ++k) sum.equations.hessian[k] += hessian[k];
    for (int k = 0; k < 6; ++k) sum.equations.gradient[k] += gradient[k];
}

PoseUncertainty EdgeClusters::uncertainty(const PoseSystem& system, double slope) const {
    const Vector6d step = system.solve();
    PoseSystem of_edges;
    for (const Sum& edge : sums_)
        if (edge.used) of_edges.add(edge.equations);
    const Matrix6d by_slopes = system.hessian - (1 - slope) * of_edges.hessian;
    PoseUncertainty out;
    out.influences.reserve(sums_.size());
    for (std::size_t k = 0; k < sums_.size(); ++k) {
        if (!sums_[k].used) continue;
        PoseSystem edge;
        edge.add(sums_[k].equations);
        const Vector6d at_optimum = edge.gradient + edge.hessian * step;
        const Eigen::LLT<Matrix6d> others(by_slopes - slope * edge.hessian);
        // Without this edge there may be no pose at all
        const bool solvable = others.info() == Eigen::Success;
        out.influences.push_back({clusters_[k], solvable ? Vector6d(others.solve(at_optimum))
                                                         : Vector6d::Constant(kNothingKnown)});
    }
    const auto used = static_cast<double>(out.influences.size());
    for (EdgeInfluence& edge : out.influences) edge.moved *= std::sqrt(std::max(1.0, used - 1) / used);
    out.independent = system.hessian.inverse();
    return out;
}

}  // namespace roevo
