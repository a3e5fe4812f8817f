#include "roevo/tracking/edge_association.h"

#include <algorithm>
#include <cmath>

#include "roevo/edges/canny.h"

namespace roevo {

void EdgeAssociator::associate(const OrganizedEdges& reference, const float* u, const float* v,
                               const float* gradient_u, const float* gradient_v, int span,
                               const OrganizedEdges& current, const EdgeGrid& grid, int width, int height,
                               double radius, EdgeMatches& out) {
    out.point.assign(reference.size(), -1);
    out.visible_points = 0;
    const auto min_cosine =
        static_cast<float>(std::cos(options_.normal_angle_deg * (3.14159265358979323846 / 180)));
    const float margin = EdgeMask::kBorder;
    const float max_u = static_cast<float>(width) - 1 - margin,
                max_v = static_cast<float>(height) - 1 - margin;
    visible_.assign(static_cast<std::size_t>(reference.numEdges()), 0);
    stride_ = static_cast<int>((reference.size() + static_cast<std::size_t>(options_.max_points) - 1) /
                               static_cast<std::size_t>(options_.max_points));
    for (int e = 0; e < reference.numEdges(); ++e) {
        const int first = reference.begin[static_cast<std::size_t>(e)];
        const int last = reference.begin[static_cast<std::size_t>(e) + 1] - 1;
        for (int i = first + ((last - first) % stride_) / 2; i <= last; i += stride_) {
            const auto at = static_cast<std::size_t>(i);
            if (!(u[at] >= margin && v[at] >= margin && u[at] <= max_u && v[at] <= max_v)) continue;
            ++visible_[static_cast<std::size_t>(e)];
            const auto before = static_cast<std::size_t>(std::max(first, i - span));
            const auto after = static_cast<std::size_t>(std::min(last, i + span));
            const float tx = u[after] - u[before], ty = v[after] - v[before];
            const float length = std::sqrt(tx * tx + ty * ty);
            if (!(length > 0)) continue;
            float nx = -ty / length, ny = tx / length;            // Eq. (5)
            if (nx * gradient_u[at] + ny * gradient_v[at] < 0) {  // Eqs. (6), (7)
                nx = -nx;
                ny = -ny;
            }
            out.point[at] =
                grid.nearest(u[at], v[at], static_cast<float>(radius), [&](std::size_t candidate) {
                    return nx * current.normal_x[candidate] + ny * current.normal_y[candidate] >= min_cosine;
                });
        }
        out.visible_points += visible_[static_cast<std::size_t>(e)];
    }
    vote(reference, current, out);
}

void EdgeAssociator::vote(const OrganizedEdges& reference, const OrganizedEdges& current,
                          EdgeMatches& matches) {
    matches.num_points = matches.visible_edges = matches.matched_edges = matches.matched_extent = 0;
    votes_.assign(static_cast<std::size_t>(current.numEdges()), 0);
    for (int e = 0; e < reference.numEdges(); ++e) {
        const auto first = static_cast<std::size_t>(reference.begin[static_cast<std::size_t>(e)]);
        const auto end = static_cast<std::size_t>(reference.begin[static_cast<std::size_t>(e) + 1]);
        const int visible = visible_[static_cast<std::size_t>(e)];
        const auto visited =
            (end - first + static_cast<std::size_t>(stride_) - 1) / static_cast<std::size_t>(stride_);
        const bool mostly_inside = 2 * static_cast<std::size_t>(visible) >= visited;
        if (!mostly_inside) {  // says nothing about the share of the keyframe that is seen again
            if (visible == 0) continue;
        } else {
            ++matches.visible_edges;
        }
        touched_.clear();
        for (std::size_t i = first; i < end; ++i) {
            if (matches.point[i] < 0) continue;
            const std::int32_t other = current.edge_of[static_cast<std::size_t>(matches.point[i])];
            if (votes_[static_cast<std::size_t>(other)]++ == 0) touched_.push_back(other);
        }
        int agreed = 0;
        for (std::size_t i = first; i < end; ++i) {
            if (matches.point[i] < 0) continue;
            const auto other =
                static_cast<std::size_t>(current.edge_of[static_cast<std::size_t>(matches.point[i])]);
            const int other_length = current.begin[other + 1] - current.begin[other];
            const double needed = std::max<double>(
                static_cast<double>(options_.min_votes) / stride_,
                options_.vote_ratio * std::min<double>(visible, static_cast<double>(other_length) / stride_));
            if (votes_[other] >= needed) {
                ++agreed;
            } else {
                matches.point[i] = -1;
            }
        }
        for (const std::int32_t other : touched_) votes_[static_cast<std::size_t>(other)] = 0;
        matches.num_points += agreed;
        if (agreed > 0) {
            if (mostly_inside) ++matches.matched_edges;
            matches.matched_extent += visible;
        }
    }
}

}  // namespace roevo
