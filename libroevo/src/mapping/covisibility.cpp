#include "mapping/covisibility.h"

#include <limits>
#include <numeric>

namespace roevo {
namespace {

constexpr int kTangentSpan = 3;  ///< points of thinned edges to each side

}  // namespace

CovisibilityGraph::CovisibilityGraph(const PinholeCamera& camera, const FineOptions& fine)
    : camera_(camera), associator_(camera, forThinned(fine), kTangentSpan) {
    associator_.limit(std::numeric_limits<int>::max());
}

void CovisibilityGraph::insert(const MapKeyframe& current, const std::vector<const MapKeyframe*>& others,
                               double radius) {
    auto& of_current = links_[current.id];
    std::vector<char> associated(static_cast<std::size_t>(current.image.numEdges()), 0);
    constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
    for (const MapKeyframe* other : others) {
        const Pose T_other_current = other->T_world_camera.inverse() * current.T_world_camera;
        project(current.points, T_other_current, camera_, RowMotion(), projected_);
        for (std::size_t i = 0; i < current.size(); ++i) {
            if (at(associated, current.image.edge_of[i]) != 0) projected_.u[i] = kNowhere;
        }
        grid_.build(other->image, camera_.width, camera_.height);
        associator_.associate(current.image, projected_, T_other_current, other->image, grid_, radius,
                              matches_);
        Links found{other->id, {}};
        std::vector<Link>& links = found.links;
        // Pairs come in the order of the current edges
        for (std::size_t k = 0; k < matches_.size(); ++k) {
            const auto edge = static_cast<std::size_t>(at(current.image.edge_of, matches_.reference[k]));
            const auto other_edge = static_cast<std::size_t>(at(other->image.edge_of, matches_.current[k]));
            associated[edge] = 1;
            auto same = links.rbegin();
            while (same != links.rend() && same->edge == edge && same->other_edge != other_edge) ++same;
            if (same != links.rend() && same->edge == edge) {
                if (same->points < std::numeric_limits<std::uint16_t>::max()) ++same->points;
            } else {
                links.push_back(
                    {static_cast<std::uint16_t>(edge), static_cast<std::uint16_t>(other_edge), 1});
            }
        }
        links.shrink_to_fit();
        if (!links.empty()) of_current.push_back(std::move(found));
    }
}

std::vector<CovisibilityGraph::Links> CovisibilityGraph::linksOf(int keyframe) const {
    const auto found = links_.find(keyframe);
    return found == links_.end() ? std::vector<Links>() : found->second;
}

std::vector<std::vector<int>> CovisibilityGraph::clusters(
    const std::vector<const MapKeyframe*>& keyframes) const {
    std::vector<std::pair<int, int>> edges;
    for (const MapKeyframe* keyframe : keyframes)
        edges.emplace_back(keyframe->id, keyframe->image.numEdges());
    return clustersOf(edges, [&](int id) {
        const auto found = links_.find(id);
        return found == links_.end() ? nullptr : &found->second;
    });
}

std::vector<std::vector<int>> clustersOf(
    const std::vector<std::pair<int, int>>& keyframes,
    const std::function<const std::vector<CovisibilityGraph::Links>*(int)>& linksOf) {
    std::map<int, std::size_t> first_edge;
    std::size_t count = 0;
    for (const auto& [id, edges] : keyframes) {
        first_edge[id] = count;
        count += static_cast<std::size_t>(edges);
    }
    std::vector<std::size_t> parent(count);  // disjoint sets
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto find = [&](std::size_t edge) {
        while (parent[edge] != edge) edge = parent[edge] = parent[parent[edge]];
        return edge;
    };
    for (const auto& [id, first] : first_edge) {
        const auto* const groups = linksOf(id);
        if (groups == nullptr) continue;
        for (const CovisibilityGraph::Links& group : *groups) {
            const auto other = first_edge.find(group.other);
            if (other == first_edge.end()) continue;
            for (const CovisibilityGraph::Link& link : group.links)
                parent[find(first + link.edge)] = find(other->second + link.other_edge);
        }
    }
    std::vector<int> number(count, -1);
    int next = 0;
    std::vector<std::vector<int>> result;
    for (const auto& [id, edges] : keyframes) {
        const std::size_t first = first_edge[id];
        auto& of_edges = result.emplace_back();
        for (int e = 0; e < edges; ++e) {
            int& cluster = number[find(first + static_cast<std::size_t>(e))];
            if (cluster < 0) cluster = next++;
            of_edges.push_back(cluster);
        }
    }
    return result;
}

}  // namespace roevo
