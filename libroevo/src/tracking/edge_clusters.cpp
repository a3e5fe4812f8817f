#include "tracking/edge_clusters.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tracking/gauss_newton.h"
#include "tracking/se3.h"

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
    std::vector<std::int32_t> clusters = cluster_of;
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    sums_.assign(clusters.size(), Sum());
    for (std::size_t i = 0; i < clusters.size(); ++i) sums_[i].cluster = clusters[i];
    slot_of_.clear();
    for (const std::int32_t cluster : cluster_of) {
        const auto at = std::lower_bound(clusters.begin(), clusters.end(), cluster);
        slot_of_.push_back(static_cast<std::int32_t>(at - clusters.begin()));
    }
}

void EdgeClusters::add(std::size_t edge, const float (&matrix)[6], const float (&vector)[3],
                       const Eigen::Vector3d& point) {
    if (edge >= slot_of_.size()) return;  // of points that are no edge points, as experiments choose them
    Sum& sum = sums_[static_cast<std::size_t>(slot_of_[edge])];
    sum.used = true;
    Eigen::Matrix3f M;
    M << matrix[0], matrix[1], matrix[2], matrix[1], matrix[3], matrix[4], matrix[2], matrix[4], matrix[5];
    const Eigen::Matrix3d information = M.cast<double>();
    const Eigen::Vector3d pull = Eigen::Vector3f(vector[0], vector[1], vector[2]).cast<double>();
    const Eigen::Matrix3d P = skew(point), turned = P * information;
    sum.hessian.topLeftCorner<3, 3>() += information;
    sum.hessian.bottomLeftCorner<3, 3>() += turned;
    sum.hessian.topRightCorner<3, 3>() += turned.transpose();
    sum.hessian.bottomRightCorner<3, 3>() -= turned * P;
    sum.gradient.head<3>() += pull;
    sum.gradient.tail<3>() += point.cross(pull);
}

PoseUncertainty EdgeClusters::uncertainty(const PoseSystem& system, double slope) const {
    const Vector6d step = system.solve();
    Matrix6d by_slopes = system.hessian;
    for (const Sum& edge : sums_) by_slopes -= (1 - slope) * edge.hessian;
    PoseUncertainty out;
    for (const Sum& edge : sums_) {
        if (!edge.used) continue;
        const Vector6d at_optimum = edge.gradient + edge.hessian * step;
        out.influences.push_back({edge.cluster, (by_slopes - slope * edge.hessian).ldlt().solve(at_optimum)});
    }
    const auto used = static_cast<double>(out.influences.size());
    for (EdgeInfluence& edge : out.influences) edge.moved *= std::sqrt((used - 1) / used);
    out.independent = system.hessian.inverse();
    return out;
}

}  // namespace roevo
