#include "tracking/edge_association.h"

#include <algorithm>
#include <cmath>

#include "edges/canny.h"
#include "roevo/types.h"

namespace roevo {
namespace {

/// Along an edge from point p to where it is nearest to (u, v), as long as it comes nearer.
std::size_t walk(const OrganizedEdges& edges, std::size_t p, float u, float v) {
    const IndexRange edge = edges.pointsOf(edges.edge_of[p]);
    const auto squaredTo = [&](std::size_t point) {
        const float du = edges.x[point] - u, dv = edges.y[point] - v;
        return du * du + dv * dv;
    };
    const float here = squaredTo(p);
    float nearest = here;
    for (float next; p + 1 < edge.end && (next = squaredTo(p + 1)) < nearest; ++p) nearest = next;
    if (nearest == here)
        for (float next; p > edge.first && (next = squaredTo(p - 1)) < nearest; --p) nearest = next;
    return p;
}

}  // namespace

void EdgeAssociator::associate(const OrganizedEdges& reference, const float* u, const float* v,
                               const Eigen::Vector2f& turn, int span, const OrganizedEdges& current,
                               const EdgeGrid& grid, int width, int height, double radius, EdgeMatches& out) {
    out.reference.clear();
    out.current.clear();
    out.looked_up_points = out.visible_points = 0;
    const auto min_cosine = static_cast<float>(std::cos(options_.normal_angle_deg * kDegree));
    const float margin = EdgeMask::kBorder;
    const float max_u = static_cast<float>(width) - 1 - margin,
                max_v = static_cast<float>(height) - 1 - margin;
    out.visible.assign(static_cast<std::size_t>(reference.numEdges()), 0);
    stride_ = strideFor(reference.size(), options_.max_points);
    const auto reach = static_cast<std::size_t>(span);
    for (int e = 0; e < reference.numEdges(); ++e) {
        const IndexRange own = reference.pointsOf(e);
        int visible = 0;
        int before_this = -1;  // what a point before is associated with: it goes on along that edge, mostly
        for (std::size_t i = own.first + (stride_ / 2 + stride_ - own.first % stride_) % stride_; i < own.end;
             i += stride_) {
            ++out.looked_up_points;
            if (!(u[i] >= margin && v[i] >= margin && u[i] <= max_u && v[i] <= max_v)) continue;
            ++visible;
            const auto [before, end] = own.around(i, reach);
            const float side_x = turn.x() * reference.normal_x[i] - turn.y() * reference.normal_y[i];
            const float side_y = turn.y() * reference.normal_x[i] + turn.x() * reference.normal_y[i];
            float nx, ny;
            if (!edgeNormal(u[end - 1] - u[before], v[end - 1] - v[before], side_x, side_y, nx, ny)) continue;
            const int guess =
                before_this < 0
                    ? -1
                    : static_cast<int>(walk(current, static_cast<std::size_t>(before_this), u[i], v[i]));
            const auto agrees = [&](const EdgeGrid::Point& point) {
                return nx * point.normal_x + ny * point.normal_y >= min_cosine;
            };
            const int found = grid.nearest(u[i], v[i], static_cast<float>(radius), agrees, guess);
            if (found < 0) continue;
            before_this = found;
            out.reference.push_back(static_cast<std::int32_t>(i));
            out.current.push_back(found);
        }
        out.visible[static_cast<std::size_t>(e)] = visible;
        out.visible_points += visible;
    }
    vote(reference, current, out);
}

void EdgeAssociator::vote(const OrganizedEdges& reference, const OrganizedEdges& current,
                          EdgeMatches& matches) {
    matches.matched_extent = 0;
    const auto stride = static_cast<double>(stride_);
    votes_.assign(static_cast<std::size_t>(current.numEdges()), 0);
    const auto otherEdge = [&](std::size_t pair) {
        return static_cast<std::size_t>(current.edge_of[static_cast<std::size_t>(matches.current[pair])]);
    };
    std::size_t kept = 0, next = 0;  // pairs are in the order of the reference's edges
    for (int e = 0; e < reference.numEdges(); ++e) {
        const int visible = matches.visible[static_cast<std::size_t>(e)];
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
        for (const std::int32_t other : touched_) votes_[static_cast<std::size_t>(other)] = 0;
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
