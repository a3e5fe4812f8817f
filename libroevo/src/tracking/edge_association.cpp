#include "tracking/edge_association.h"

#include <algorithm>
#include <cmath>

#include "tracking/se3.h"

namespace roevo {

void EdgeAssociator::associate(const OrganizedEdges& reference, const ProjectedPoints3& projected,
                               const Pose& T_current_reference, const OrganizedEdges& current,
                               const EdgeGrid& grid, double radius, EdgeMatches& out) {
    const float margin = EdgeMask::kBorder;
    const std::vector<float>&u = projected.u, &v = projected.v;
    const Eigen::Vector2f turn = imageRotation(T_current_reference);
    stride_ = strideFor(reference.size(), options_.max_points);
    const std::size_t most = reference.size() / stride_ + static_cast<std::size_t>(reference.numEdges());
    for (auto* values :
         {&queries_.u, &queries_.v, &queries_.normal_x, &queries_.normal_y, &side_x_, &side_y_})
        values->resize(most);
    out.reference.resize(most);
    out.visible.resize(static_cast<std::size_t>(reference.numEdges()));
    out.looked_up_points = 0;
    std::size_t n = 0;
    for (int e = 0; e < reference.numEdges(); ++e) {
        const IndexRange own = reference.pointsOf(e);
        const std::size_t before_this = n;
        for (std::size_t i = own.first + (stride_ / 2 + stride_ - own.first % stride_) % stride_; i < own.end;
             i += stride_) {
            ++out.looked_up_points;
            if (!(u[i] >= margin && v[i] >= margin && u[i] <= max_u_ && v[i] <= max_v_)) continue;
            const auto [before, end] = own.around(i, span_);
            out.reference[n] = static_cast<std::int32_t>(i);
            queries_.u[n] = u[i];
            queries_.v[n] = v[i];
            queries_.normal_x[n] = u[end - 1] - u[before];  // the chord, at first
            queries_.normal_y[n] = v[end - 1] - v[before];
            side_x_[n] = turn.x() * reference.normal_x[i] - turn.y() * reference.normal_y[i];
            side_y_[n] = turn.y() * reference.normal_x[i] + turn.x() * reference.normal_y[i];
            ++n;
        }
        at(out.visible, e) = static_cast<std::int32_t>(n - before_this);
    }
    out.visible_points = static_cast<int>(n);
    kernels::best().normals(queries_.normal_x.data(), queries_.normal_y.data(), side_x_.data(),
                            side_y_.data(), n, queries_.normal_x.data(), queries_.normal_y.data());
    out.current.resize(n);
    grid.nearest(queries_, n, radius, std::cos(options_.normal_angle_deg * kDegree), out.current.data());
    std::size_t found = 0;
    for (std::size_t pair = 0; pair < n; ++pair) {
        out.reference[found] = out.reference[pair];
        out.current[found] = out.current[pair];
        found += out.current[pair] >= 0 ? 1 : 0;
    }
    out.reference.resize(found);
    out.current.resize(found);
    vote(reference, current, out);
}

void EdgeAssociator::vote(const OrganizedEdges& reference, const OrganizedEdges& current,
                          EdgeMatches& matches) {
    matches.matched_extent = 0;
    const auto stride = static_cast<double>(stride_);
    votes_.assign(static_cast<std::size_t>(current.numEdges()), 0);
    const auto otherEdge = [&](std::size_t pair) {
        return static_cast<std::size_t>(at(current.edge_of, matches.current[pair]));
    };
    std::size_t kept = 0, next = 0;  // pairs are in the order of the reference's edges
    for (int e = 0; e < reference.numEdges(); ++e) {
        const int visible = at(matches.visible, e);
        const std::size_t first = next;
        touched_.clear();
        const std::size_t end = reference.pointsOf(e).end;
        for (; next < matches.size() && static_cast<std::size_t>(matches.reference[next]) < end; ++next) {
            const std::size_t other = otherEdge(next);
            if (votes_[other]++ == 0) touched_.push_back(static_cast<std::int32_t>(other));
        }
        const std::size_t kept_before = kept;
        for (std::size_t pair = first; pair < next; ++pair) {
            const std::size_t other = otherEdge(pair);
            const auto other_length = static_cast<double>(current.pointsOf(other).size());
            const double needed =
                std::max(options_.min_votes / stride,
                         options_.vote_ratio * std::min<double>(visible, other_length / stride));
            if (votes_[other] < needed) continue;
            matches.reference[kept] = matches.reference[pair];
            matches.current[kept] = matches.current[pair];
            ++kept;
        }
        for (const std::int32_t other : touched_) at(votes_, other) = 0;
        if (kept > kept_before) matches.matched_extent += visible;
    }
    matches.reference.resize(kept);
    matches.current.resize(kept);
}

FineOptions forThinned(FineOptions options) {
    options.min_votes = std::min(options.min_votes, 2);
    return options;
}

}  // namespace roevo
