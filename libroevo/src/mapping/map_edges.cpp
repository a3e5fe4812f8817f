// The map that is shown: edges of all keyframes.
#include <algorithm>
#include <array>

#include "mapping/edge_smoothing.h"
#include "mapping/local_mapper.h"

namespace roevo {
namespace {

constexpr int kIterations = 3;  ///< that fit the fused points; the poses stay

std::vector<const MapKeyframe*> pointersTo(const std::map<int, MapKeyframe>& keyframes) {
    std::vector<const MapKeyframe*> pointers;
    for (const auto& [id, keyframe] : keyframes) pointers.push_back(&keyframe);
    return pointers;
}

}  // namespace

/// All keyframes with their points.
std::map<int, MapKeyframe> LocalMapper::unpacked() const {
    std::map<int, MapKeyframe> all = keyframes_;
    for (auto& [id, keyframe] : all) {
        unpack(keyframe);
        bringToReadout(keyframe);
    }
    return all;
}

/// What most of the keyframes' edges that each fused edge is made of were thought to be.
void LocalMapper::takeKeptVerdicts(const std::vector<WindowKeyframe>& window, FusedEdges& edges) {
    for (std::size_t edge = 0; edge < edges.views.size(); ++edge) {
        std::array<int, 4> votes{};
        const auto [first, end] = edges.observationsOfEdge(edge);
        for (std::size_t k = first; k < end; ++k) {
            const MapKeyframe& keyframe = *at(window, edges.observations[k].slot).keyframe;
            if (keyframe.verdicts.empty()) continue;
            const std::int32_t own = at(keyframe.image.edge_of, edges.observations[k].point);
            ++at(votes, at(keyframe.verdicts, own));
        }
        const auto most = std::max_element(votes.begin(), votes.end());
        edges.verdicts[edge] = static_cast<EdgeVerdict>(most - votes.begin());
    }
}

EdgeMap LocalMapper::fusedMap() const {
    const std::map<int, MapKeyframe> keyframes = unpacked();
    std::vector<WindowKeyframe> window;
    for (const auto& [id, keyframe] : keyframes) window.push_back({&keyframe, keyframe.T_world_camera, true});
    FusedEdges edges = EdgeFuser(options_.sensor).fuse(window, graph_.clusters(pointersTo(keyframes)));
    BundleAdjuster(options_.mapping, options_.sensor, camera_).refine(window, edges, {}, kIterations);
    takeKeptVerdicts(window, edges);
    EdgeMap map;
    for (std::size_t number = 0; number < edges.views.size(); ++number) {
        MapEdge edge;
        edge.cluster = edges.clusters[number];
        edge.views = edges.views[number];
        edge.verdict = edges.verdicts[number];
        edge.confidence = isPseudo(edge.verdict) ? 0 : 1 - 1 / (1 + static_cast<float>(edge.views));
        const auto [first, end] = edges.pointsOf(number);
        std::vector<Eigen::Vector3d> points(edges.points.data() + first, edges.points.data() + end);
        // Observations are in reverse order: the last one is the reference's own
        const auto reference = [&](std::size_t p) {
            return edges.observations[edges.observationsOf(p).end - 1];
        };
        smoothDepthAlong(points, at(window, reference(first).slot).T_world_camera, options_.sensor);
        for (std::size_t p = first; p < end; ++p) {
            const Observation seen = reference(p);
            const MapKeyframe& keyframe = *at(window, seen.slot).keyframe;
            if (edge.points.empty()) edge.keyframe_id = keyframe.id;
            edge.points.push_back(points[p - first].cast<float>());
            edge.colours.push_back(at(keyframe.colours, seen.point));
        }
        map.push_back(std::move(edge));
    }
    return map;
}

EdgeMap LocalMapper::keyframeEdges() const {
    const std::map<int, MapKeyframe> keyframes = unpacked();
    const std::vector<std::vector<int>> clusters = graph_.clusters(pointersTo(keyframes));
    EdgeMap map;
    std::vector<Eigen::Vector3d> points;
    auto clusters_of = clusters.begin();
    for (const auto& [id, keyframe] : keyframes) {
        const std::vector<int>& own = *clusters_of++;
        for (std::size_t e = 0; e < own.size(); ++e) {
            MapEdge edge;
            edge.keyframe_id = id;
            edge.cluster = own[e];
            if (!keyframe.verdicts.empty()) edge.verdict = keyframe.verdicts[e];
            points.clear();
            const auto [first, end] = keyframe.image.pointsOf(e);
            for (std::size_t i = first; i < end; ++i) {
                points.push_back(keyframe.T_world_camera * keyframe.points.at(i));
                edge.colours.push_back(keyframe.colours[i]);
            }
            smoothDepthAlong(points, keyframe.T_world_camera, options_.sensor);
            for (const Eigen::Vector3d& point : points) edge.points.push_back(point.cast<float>());
            map.push_back(std::move(edge));
        }
    }
    return map;
}

}  // namespace roevo
