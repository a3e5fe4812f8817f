#include "tracking/edge_clusters.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "indexing.h"
#include "tracking/gauss_newton.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

Matrix6d wholeOf(const Matrix6d& upper_triangle) {
    return upper_triangle.selfadjointView<Eigen::Upper>();
}

}  // namespace

Matrix6d PoseUncertainty::own() const {
    Matrix6d sum = independent;
    for (const EdgeInfluence& edge : influences) sum.noalias() += edge.moved * edge.moved.transpose();
    return sum;
}

double PoseUncertainty::designEffect() const {
    const double effect = (own() * independent.inverse()).trace() / 6;
    return std::isfinite(effect) ? std::max(1.0, effect) : 1;
}

PoseUncertainty sum(const PoseUncertainty& first, const Matrix6d& carried, const PoseUncertainty& second) {
    PoseUncertainty out;
    out.independent = second.independent + carried * first.independent * carried.transpose();
    out.common = second.common + carried * first.common * carried.transpose();
    auto a = first.influences.begin();
    auto b = second.influences.begin();
    while (a != first.influences.end() || b != second.influences.end()) {
        const bool of_first =
            a != first.influences.end() && (b == second.influences.end() || a->cluster <= b->cluster);
        const bool of_second =
            b != second.influences.end() && (a == first.influences.end() || b->cluster <= a->cluster);
        EdgeInfluence both{of_first ? a->cluster : b->cluster, Vector6d::Zero()};
        if (of_first) both.moved += carried * (a++)->moved;
        if (of_second) both.moved += (b++)->moved;
        out.influences.push_back(both);
    }
    return out;
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
    Sum& sum = at(sums_, slot_of_[edge]);
    sum.used = true;
    Eigen::Matrix3d information;
    information << matrix[0], matrix[1], matrix[2],  //
        matrix[1], matrix[3], matrix[4],             //
        matrix[2], matrix[4], matrix[5];
    // d point / d xi = [I, turn]
    const Eigen::Matrix3d turn = -skew(point), by_turn = information * turn;
    sum.hessian.topLeftCorner<3, 3>() += information;
    sum.hessian.topRightCorner<3, 3>() += by_turn;
    sum.hessian.bottomRightCorner<3, 3>() += turn.transpose() * by_turn;
    const Eigen::Vector3d pull(vector[0], vector[1], vector[2]);
    sum.gradient.head<3>() += pull;
    sum.gradient.tail<3>() += point.cross(pull);
}

PoseUncertainty EdgeClusters::uncertainty(const PoseSystem& system, double slope,
                                          const PriorTerm* prior) const {
    const Vector6d step = system.solve();
    Matrix6d of_edges = Matrix6d::Zero();
    for (const Sum& edge : sums_) of_edges += wholeOf(edge.hessian);
    const Matrix6d by_slopes = system.hessian - (1 - slope) * of_edges;
    PoseUncertainty out;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
        const Sum& edge = sums_[k];
        if (!edge.used) continue;
        const Matrix6d hessian = wholeOf(edge.hessian);
        const Vector6d at_optimum = edge.gradient + hessian * step;
        const Eigen::LLT<Matrix6d> others(by_slopes - slope * hessian);
        // Without this edge there may be no pose at all
        const bool solvable = others.info() == Eigen::Success;
        out.influences.push_back({clusters_[k], solvable ? Vector6d(others.solve(at_optimum))
                                                         : Vector6d::Constant(kNothingKnown)});
    }
    const auto used = static_cast<double>(out.influences.size());
    for (EdgeInfluence& edge : out.influences) edge.moved *= std::sqrt(std::max(1.0, used - 1) / used);
    const Matrix6d inverse = system.hessian.inverse();
    if (prior == nullptr) {
        out.independent = inverse;
        return out;
    }
    out.independent = inverse * (system.hessian - prior->information()) * inverse;
    const Matrix6d kept = by_slopes.inverse() * prior->information();  // of the errors of its mean
    return sum(prior->errors(), kept, out);
}

}  // namespace roevo
