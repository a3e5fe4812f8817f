#include "tracking/edge_association.h"

#include <algorithm>
#include <cmath>

#include "edges/canny.h"
#include "roevo/types.h"

namespace roevo {

void EdgeAssociator::associate(const OrganizedEdges& reference, const float* u, const float* v,
                               const Eigen::Vector2f& turn, int span, const OrganizedEdges& current,
                               const EdgeGrid& grid, int width, int height, double radius, EdgeMatches& out) {
    out.reference.clear();
    out.current.clear();
    out.visible_points = 0;
    const auto min_cosine = static_cast<float>(std::cos(options_.normal_angle_deg * kDegree));
    const float margin = EdgeMask::kBorder;
    const float max_u = static_cast<float>(width) - 1 - margin,
                max_v = static_cast<float>(height) - 1 - margin;
    out.visible.assign(static_cast<std::size_t>(reference.numEdges()), 0);
    stride_ =
        std::max(1, static_cast<int>((reference.size() + static_cast<std::size_t>(options_.max_points) - 1) /
                                     static_cast<std::size_t>(options_.max_points)));
    for (int e = 0; e < reference.numEdges(); ++e) {
        const int first = reference.begin[static_cast<std::size_t>(e)];
        const int last = reference.begin[static_cast<std::size_t>(e) + 1] - 1;
        int visible = 0;
        for (int i = first + (stride_ / 2 + stride_ - first % stride_) % stride_; i <= last; i += stride_) {
            const auto at = static_cast<std::size_t>(i);
            if (!(u[at] >= margin && v[at] >= margin && u[at] <= max_u && v[at] <= max_v)) continue;
            ++visible;
            const auto before = static_cast<std::size_t>(std::max(first, i - span));
            const auto after = static_cast<std::size_t>(std::min(last, i + span));
            const float tx = u[after] - u[before], ty = v[after] - v[before];
            const float length = std::sqrt(tx * tx + ty * ty);
            if (!(length > 0)) continue;
            float nx = -ty / length, ny = tx / length;  // Eq. (4)
            const float gx = turn.x() * reference.gradient_x[at] - turn.y() * reference.gradient_y[at];
            const float gy = turn.y() * reference.gradient_x[at] + turn.x() * reference.gradient_y[at];
            if (nx * gx + ny * gy < 0) {  // Eqs. (5), (6)
                nx = -nx;
                ny = -ny;
            }
            const int found =
                grid.nearest(u[at], v[at], static_cast<float>(radius), [&](std::size_t candidate) {
                    return nx * current.normal_x[candidate] + ny * current.normal_y[candidate] >= min_cosine;
                });
            if (found < 0) continue;
            out.reference.push_back(i);
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
    votes_.assign(static_cast<std::size_t>(current.numEdges()), 0);
    const auto otherEdge = [&](std::size_t pair) {
        return static_cast<std::size_t>(current.edge_of[static_cast<std::size_t>(matches.current[pair])]);
    };
    std::size_t kept = 0, next = 0;  // pairs are in the order of the reference's edges
    for (int e = 0; e < reference.numEdges(); ++e) {
        const int visible = matches.visible[static_cast<std::size_t>(e)];
        const std::size_t first = next;
        touched_.clear();
        const std::int32_t end = reference.begin[static_cast<std::size_t>(e) + 1];
        for (; next < matches.size() && matches.reference[next] < end; ++next) {
            const std::size_t other = otherEdge(next);
            if (votes_[other]++ == 0) touched_.push_back(static_cast<std::int32_t>(other));
        }
        const std::size_t kept_before = kept;
        for (std::size_t pair = first; pair < next; ++pair) {
            const std::size_t other = otherEdge(pair);
            const int other_length = current.begin[other + 1] - current.begin[other];
            const double needed = std::max<double>(
                static_cast<double>(options_.min_votes) / stride_,
                options_.vote_ratio * std::min<double>(visible, static_cast<double>(other_length) / stride_));
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

}  // namespace roevo
