#include "stored_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace roevo {
namespace {

constexpr double kFarthest = 1e6;        // m; no map is as large
constexpr double kMostUncertain = 1e12;  // m^2, rad^2; what is known so badly is not known
constexpr float kMostOfPlace = 1e4F;     // m, px, rad

/// Leaves some.
template <class T>
void keepSome(const std::vector<bool>& kept, std::vector<T>& values) {
    std::size_t i = 0;
    eraseIf(values, [&](const T&) { return !kept[i++]; });
}

bool isSound(const Pose& pose) {
    return pose.isFinite() && pose.translation().cwiseAbs().maxCoeff() < kFarthest;
}

bool isSound(const Matrix6d& covariance) {
    return covariance.allFinite() && covariance.cwiseAbs().maxCoeff() < kMostUncertain &&
           covariance.diagonal().minCoeff() >= 0;
}

bool isSound(const PlacePoints& points) {
    const auto known = [](float value) { return std::abs(value) < kMostOfPlace; };
    return points.size() <= kMaxPlacePoints &&
           std::all_of(points.begin(), points.end(), [&](const PlacePoint& p) {
               return known(p.x) && known(p.y) && known(p.z) && p.z > 0 && known(p.u) && known(p.v) &&
                      known(p.normal_angle);
           });
}

bool isSound(const RowMotion& rows, const PinholeCamera& camera) {
    constexpr double kMost = 1e3;  // m/s, rad/s
    return rows.velocity.allFinite() && rows.velocity.norm() < kMost && rows.turn.allFinite() &&
           rows.turn.norm() < kMost && std::abs(rows.seconds_per_row) * camera.height < 1 &&
           rows.reference_row >= 0 && rows.reference_row <= camera.height;
}

/// @param id     of the keyframe
bool linksAreSound(const StoredMap& map, std::size_t id) {
    const int edges = map.edges[id].points.numEdges();
    for (const CovisibilityGraph::Links& links : map.edges[id].links) {
        if (links.other < 0 || links.other >= static_cast<int>(id)) return false;
        const int others = at(map.edges, links.other).points.numEdges();
        for (const CovisibilityGraph::Link& link : links.links)
            if (link.edge >= edges || link.other_edge >= others) return false;
    }
    return true;
}

bool edgesAreSound(const StoredMap& map, std::size_t id) {
    const KeptKeyframe& own = map.edges[id];
    const auto edges = static_cast<std::size_t>(own.points.numEdges());
    const auto is_share = [](float share) { return share >= -1 && share <= 1; };
    const auto is_verdict = [](EdgeVerdict v) { return v <= EdgeVerdict::kVanishing; };
    return own.points.isSound(map.camera) && own.median_depth >= 0 && own.median_depth < kFarthest &&
           isSound(own.row_motion, map.camera) && own.found.size() == edges &&
           std::all_of(own.found.begin(), own.found.end(), is_share) &&
           (own.verdicts.empty() || own.verdicts.size() == edges) &&
           std::all_of(own.verdicts.begin(), own.verdicts.end(), is_verdict) && linksAreSound(map, id);
}

bool graphIsSound(const KeyframeGraph& graph) {
    const auto count = static_cast<int>(graph.keyframes.size());
    for (int id = 0; id < count; ++id) {
        const KeyframeInfo& keyframe = at(graph.keyframes, id);
        const RelativePose& link = at(graph.links, id);
        // One track: all but the first are linked to older ones
        if (keyframe.id != id || !std::isfinite(keyframe.timestamp) || !isSound(keyframe.T_world_camera) ||
            link.keyframe >= id || (link.keyframe < 0) != (id == 0) || !isSound(link.T_keyframe_camera) ||
            !isSound(link.covariance()) || !isSound(at(graph.covariances, id)))
            return false;
    }
    const auto is_pair = [&](int older, int newer) { return older >= 0 && older < newer && newer < count; };
    return std::all_of(graph.related.begin(), graph.related.end(),
                       [&](const auto& pair) { return is_pair(pair.first, pair.second); }) &&
           std::all_of(graph.loops.begin(), graph.loops.end(), [&](const PoseConstraint& loop) {
               return is_pair(loop.from, loop.to) && isSound(loop.T_from_to) && isSound(loop.covariance);
           });
}

}  // namespace

void keepOnly(const std::vector<bool>& kept, StoredMap& map) {
    std::vector<int> ids;  // of each, now; -1: none
    int next = 0;
    for (const bool keep : kept) ids.push_back(keep ? next++ : -1);
    const auto now = [&](int id) { return id < 0 ? -1 : at(ids, id); };

    KeyframeGraph& graph = map.graph;
    for (KeyframeInfo& keyframe : graph.keyframes) keyframe.id = now(keyframe.id);
    for (RelativePose& link : graph.links) link.keyframe = now(link.keyframe);
    for (auto& [older, newer] : graph.related) older = now(older), newer = now(newer);
    for (PoseConstraint& loop : graph.loops) loop.from = now(loop.from), loop.to = now(loop.to);
    eraseIf(graph.related, [](const auto& pair) { return std::min(pair.first, pair.second) < 0; });
    eraseIf(graph.loops, [](const PoseConstraint& loop) { return std::min(loop.from, loop.to) < 0; });
    for (KeptKeyframe& edges : map.edges) {
        for (CovisibilityGraph::Links& links : edges.links) links.other = now(links.other);
        eraseIf(edges.links, [](const CovisibilityGraph::Links& links) { return links.other < 0; });
    }
    keepSome(kept, graph.keyframes);
    keepSome(kept, graph.links);
    keepSome(kept, graph.covariances);
    keepSome(kept, map.places);
    keepSome(kept, map.edges);
    keepSome(kept, map.surfaces);
}

std::string faultOf(const StoredMap& map) {
    if (std::string fault = map.camera.check(); !fault.empty()) return fault;
    const std::size_t count = map.graph.keyframes.size();
    if (count == 0) return "it has no keyframes";
    for (const std::size_t size : {map.graph.links.size(), map.graph.covariances.size(), map.places.size(),
                                   map.edges.size(), map.surfaces.size()})
        if (size != count) return "not all is there of each of its keyframes";
    if (!graphIsSound(map.graph)) return "poses of keyframes are none, or beyond 1000 km from the origin";
    for (std::size_t id = 0; id < count; ++id)
        if (!isSound(map.places[id]) || !edgesAreSound(map, id) || !map.surfaces[id].isSound())
            return "keyframe " + std::to_string(id) + " is none";
    return "";
}

std::string describe(const PinholeCamera& camera) {
    std::ostringstream text;
    text.precision(9);
    text << camera.width << "x" << camera.height << ", fx " << camera.fx << ", fy " << camera.fy << ", cx "
         << camera.cx << ", cy " << camera.cy;
    if (!camera.isDistorted()) return text.str();
    text << ", lens";
    if (camera.lens == LensModel::kKannalaBrandt) text << " (fish-eye)";
    for (const double k : camera.distortion) text << " " << k;
    if (camera.isRational())
        for (const double k : camera.denominator) text << " " << k;
    return text.str();
}

}  // namespace roevo
