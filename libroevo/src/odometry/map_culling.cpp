// Maps do not grow where the camera only comes by again.
#include <algorithm>
#include <map>

#include "keyframe_maker.h"
#include "stored_map.h"

namespace roevo {
namespace {

/// Of what makes a keyframe due. Places are recognised from about there; with 0.5 and more later, from afar.
constexpr double kNear = 0.3;

using Link = CovisibilityGraph::Link;
using Clusters = std::vector<std::vector<int>>;  ///< of each edge of each keyframe

Clusters clustersIn(const StoredMap& map) {
    std::vector<std::pair<int, int>> keyframes;
    for (const KeptKeyframe& edges : map.edges)
        keyframes.emplace_back(static_cast<int>(keyframes.size()), edges.points.numEdges());
    return clustersOf(keyframes, [&](int id) { return &at(map.edges, id).links; });
}

std::size_t numberOf(const Clusters& clusters) {
    int last = -1;
    for (const auto& of_edges : clusters)
        for (const int cluster : of_edges) last = std::max(last, cluster);
    return static_cast<std::size_t>(last + 1);
}

/// Whether one of those before it that stay has about the same view.
bool isNearKept(const StoredMap& map, std::size_t id, const std::vector<bool>& kept,
                const KeyframeOptions& due) {
    const auto& keyframes = map.graph.keyframes;
    for (std::size_t other = 0; other < id; ++other) {
        if (!kept[other]) continue;
        const Pose T = keyframes[other].T_world_camera.inverse() * keyframes[id].T_world_camera;
        if (changeOfView(map.edges[other].median_depth, T, due) <= kNear) return true;
    }
    return false;
}

/// Edges that are of one cluster stay so, when those in between are gone.
void linkKept(const Clusters& clusters, const std::vector<bool>& kept, StoredMap& map) {
    struct Sighting {
        int keyframe = -1;
        std::vector<std::uint16_t> edges;
    };
    std::vector<Sighting> last(numberOf(clusters));
    for (std::size_t id = 0; id < kept.size(); ++id) {
        if (!kept[id]) continue;
        std::map<int, std::vector<std::uint16_t>> own;
        for (std::size_t e = 0; e < clusters[id].size(); ++e)
            own[clusters[id][e]].push_back(static_cast<std::uint16_t>(e));
        std::map<int, std::vector<Link>> links;
        for (const auto& [cluster, edges] : own) {
            Sighting& before = at(last, cluster);
            if (before.keyframe >= 0) {
                std::vector<Link>& to = links[before.keyframe];
                for (const std::uint16_t edge : edges) to.push_back({edge, before.edges.front(), 1});
                for (const std::uint16_t other : before.edges) to.push_back({edges.front(), other, 1});
            }
            before = {static_cast<int>(id), edges};
        }
        map.edges[id].links.clear();
        for (auto& [other, of_edges] : links) map.edges[id].links.push_back({other, std::move(of_edges)});
    }
}

}  // namespace

void leaveOutCovered(const KeyframeOptions& due, int first, StoredMap& map) {
    const Clusters clusters = clustersIn(map);
    std::vector<int> keyframes(numberOf(clusters)), last_seen(keyframes.size(), -1);  // that see a cluster
    for (std::size_t id = 0; id < clusters.size(); ++id)
        for (const int cluster : clusters[id])
            if (std::exchange(at(last_seen, cluster), static_cast<int>(id)) != static_cast<int>(id))
                ++at(keyframes, cluster);
    std::vector<bool> kept(clusters.size(), true), covered(keyframes.size(), false);
    for (std::size_t id = 0; id < kept.size(); ++id) {
        int confirmed = 0, shared = 0;  // edges: what one keyframe alone has seen may be seen by none again
        for (const int cluster : clusters[id]) {
            confirmed += at(keyframes, cluster) > 1 ? 1 : 0;
            shared += covered[static_cast<std::size_t>(cluster)] ? 1 : 0;
        }
        kept[id] = static_cast<int>(id) < first || shared < due.min_overlap * confirmed ||
                   !isNearKept(map, id, kept, due);
        if (!kept[id]) continue;
        for (const int cluster : clusters[id]) covered[static_cast<std::size_t>(cluster)] = true;
    }
    if (std::find(kept.begin(), kept.end(), false) == kept.end()) return;
    std::vector<RelativePose>& links = map.graph.links;
    for (RelativePose& link : links)
        while (link.keyframe >= 0 && !kept[static_cast<std::size_t>(link.keyframe)])
            link = compose(at(links, link.keyframe), link);
    linkKept(clusters, kept, map);
    keepOnly(kept, map);
}

}  // namespace roevo
