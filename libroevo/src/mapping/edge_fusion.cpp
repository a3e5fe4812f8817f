#include "mapping/edge_fusion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roevo {
namespace {

constexpr std::size_t kMinRun = 4;  ///< points of the shortest run that is stitched
constexpr std::int32_t kUnassigned = -1;
/// Farther from the reference than this, a point shows something else.
constexpr double kReachAngle = 12.5 / 525, kReachSigmas = 8;  // rad

}  // namespace

FusedEdges EdgeFuser::fuse(const std::vector<WindowKeyframe>& window,
                           const std::vector<std::vector<int>>& clusters) {
    std::vector<std::vector<Member>> members;  // of each cluster
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        for (std::size_t e = 0; e < clusters[slot].size(); ++e) {
            const IndexRange own = window[slot].keyframe->image.pointsOf(e);
            const auto cluster = static_cast<std::size_t>(clusters[slot][e]);
            if (cluster >= members.size()) members.resize(cluster + 1);
            members[cluster].push_back({static_cast<std::int32_t>(slot), static_cast<std::int32_t>(own.first),
                                        static_cast<std::int32_t>(own.size())});
        }
    }
    FusedEdges out;
    for (std::size_t cluster = 0; cluster < members.size(); ++cluster) {
        rest_ = std::move(members[cluster]);
        fuseCluster(window, static_cast<int>(cluster), out);
    }
    return out;
}

void EdgeFuser::observe(std::size_t node, Observation observation) {
    observations_.push_back({observation, chain_[node].first_observation});
    chain_[node].first_observation = static_cast<std::int32_t>(observations_.size()) - 1;
}

void EdgeFuser::fuseCluster(const std::vector<WindowKeyframe>& window, int cluster, FusedEdges& out) {
    while (!rest_.empty()) {
        apart_.swap(rest_);
        rest_.clear();
        chain_.clear();
        observations_.clear();
        // The longest is the reference; among equals the first
        if (apart_.size() > 1)
            std::stable_sort(apart_.begin(), apart_.end(),
                             [](const Member& a, const Member& b) { return a.length > b.length; });
        for (const Member& member : apart_) merge(window, member);
        keepChain(window.size(), cluster, out);
    }
}

void EdgeFuser::keepChain(std::size_t slots, int cluster, FusedEdges& out) {
    int views = 0;
    seen_.assign(slots, 0);
    for (const Node& node : chain_) {
        out.points.push_back(node.position);
        for (std::int32_t k = node.first_observation; k >= 0; k = at(observations_, k).next) {
            const Observation& observation = at(observations_, k).observation;
            out.observations.push_back(observation);
            char& flag = at(seen_, observation.slot);
            views += flag == 0 ? 1 : 0;
            flag = 1;
        }
        out.observation_begin.push_back(static_cast<std::int32_t>(out.observations.size()));
    }
    out.begin.push_back(static_cast<std::int32_t>(out.points.size()));
    out.clusters.push_back(cluster);
    out.views.push_back(views);
    out.verdicts.push_back(views > 1 ? EdgeVerdict::kTrue : EdgeVerdict::kUnconfirmed);
}

std::size_t EdgeFuser::nearest(const Eigen::Vector3d& p, std::size_t from, bool search_all) const {
    std::size_t best = from;
    double best_squared = (chain_[from].position - p).squaredNorm();
    const auto look = [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const double squared = (chain_[i].position - p).squaredNorm();
            if (!(squared < best_squared)) continue;
            best_squared = squared;
            best = i;
        }
    };
    if (search_all) {
        look(0, chain_.size());
        return best;
    }
    // Both edges are in order: the next point's neighbour is near the last one's
    constexpr std::size_t kLook = 4;
    std::size_t looked_from = from, looked_to = from + 1;
    while (true) {
        const std::size_t first = best > kLook ? best - kLook : 0;
        const std::size_t end = std::min(chain_.size(), best + kLook + 1);
        if (first >= looked_from && end <= looked_to) break;
        look(first, looked_from);
        look(looked_to, end);
        looked_from = std::min(looked_from, first);
        looked_to = std::max(looked_to, end);
    }
    return best;
}

bool EdgeFuser::isNear(const Eigen::Vector3d& p, const Eigen::Vector3d& reference,
                       const Eigen::Vector3d& centre) const {
    // Depth is noisy along the viewing ray only
    const Eigen::Vector3d ray = p - centre;
    const double depth = ray.norm();
    if (!(depth > 0)) return false;
    const Eigen::Vector3d apart = reference - p;
    const double along = apart.dot(ray) / depth;
    const double across_squared = apart.squaredNorm() - along * along;
    const double most_across = kReachAngle * depth;
    const double most_along = kReachSigmas * sensor_.depthSigma(depth) + most_across;
    return across_squared < most_across * most_across && std::abs(along) < most_along;
}

std::int32_t EdgeFuser::fit(const Eigen::Vector3d& p, std::size_t near) const {
    const std::size_t before = near > 0 ? near - 1 : near;
    const std::size_t after = std::min(near + 1, chain_.size() - 1);
    const Eigen::Vector3d chord = chain_[after].position - chain_[before].position;
    const double length = chord.squaredNorm();
    const double k = length > 0 ? (p - chain_[before].position).dot(chord) / length : -1;  // Eq. (14)
    if (!(k > 0 && k < 1)) return kUnassigned;
    const Eigen::Vector3d foot = chain_[before].position + k * chord;  // Eq. (15)
    std::size_t closest = near;
    for (const std::size_t candidate : {before, after}) {
        if ((chain_[candidate].position - foot).squaredNorm() <
            (chain_[closest].position - foot).squaredNorm()) {
            closest = candidate;
        }
    }
    return static_cast<std::int32_t>(closest);
}

void EdgeFuser::merge(const std::vector<WindowKeyframe>& window, const Member& member) {
    const WindowKeyframe& view = at(window, member.slot);
    const MapKeyframe& keyframe = *view.keyframe;
    const auto first = static_cast<std::size_t>(member.first);
    const auto count = static_cast<std::size_t>(member.length);
    const auto observation = [&](std::size_t i) {
        return Observation{member.slot, static_cast<std::int32_t>(first + i)};
    };
    points_.clear();
    for (std::size_t i = 0; i < count; ++i)
        points_.push_back(view.T_world_camera * keyframe.points.at(first + i));
    if (chain_.empty()) {
        for (std::size_t i = 0; i < count; ++i) {
            chain_.push_back({points_[i], -1});
            observe(i, observation(i));
        }
        return;
    }
    assigned_.assign(count, kUnassigned);
    std::size_t near = 0;
    bool search_all = true;
    for (std::size_t i = 0; i < count; ++i) {
        near = nearest(points_[i], near, search_all);
        search_all = !isNear(points_[i], chain_[near].position, view.T_world_camera.translation());
        if (search_all) continue;
        assigned_[i] = fit(points_[i], near);
        if (assigned_[i] != kUnassigned || !atEnd(near)) continue;
        // Past an end of the reference: a closed edge goes on at its other end
        const std::size_t other = nearest(points_[i], near == 0 ? chain_.size() - 1 : 0, false);
        if (atEnd(other) || !isNear(points_[i], chain_[other].position, view.T_world_camera.translation()))
            continue;
        assigned_[i] = fit(points_[i], other);
        if (assigned_[i] != kUnassigned) near = other;
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (assigned_[i] >= 0) observe(static_cast<std::size_t>(assigned_[i]), observation(i));
    }
    // Runs that did not fit: stitched where they go on from an end of the reference, else an edge of their
    // own
    for (std::size_t from = 0; from < count;) {
        if (assigned_[from] >= 0) {
            ++from;
            continue;
        }
        std::size_t to = from;
        while (to < count && assigned_[to] < 0) ++to;
        if (to - from >= kMinRun && !stitch(member, from, to)) {
            rest_.push_back(
                {member.slot, member.first + static_cast<int>(from), static_cast<int>(to - from)});
        }
        from = to;
    }
}

bool EdgeFuser::stitch(const Member& member, std::size_t from, std::size_t to) {
    const bool follows = from > 0;  // a fitted point before the run, or after it
    const std::size_t joint = follows ? from - 1 : to;
    if (joint >= assigned_.size()) return false;
    const auto anchor = static_cast<std::size_t>(assigned_[joint]);
    const bool at_front = anchor < kMinRun, at_back = anchor + kMinRun >= chain_.size();
    if (at_front == at_back) return false;
    run_.clear();
    for (std::size_t i = from; i < to; ++i) {
        observations_.push_back({{member.slot, member.first + static_cast<std::int32_t>(i)}, -1});
        run_.push_back({points_[i], static_cast<std::int32_t>(observations_.size()) - 1});
    }
    if (at_front == follows) std::reverse(run_.begin(), run_.end());
    if (at_back) {
        chain_.insert(chain_.end(), run_.begin(), run_.end());
        return true;
    }
    chain_.insert(chain_.begin(), run_.begin(), run_.end());
    for (std::int32_t& node : assigned_) {
        if (node >= 0) node += static_cast<std::int32_t>(run_.size());
    }
    return true;
}

}  // namespace roevo
