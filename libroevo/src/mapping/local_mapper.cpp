#include "mapping/local_mapper.h"

#include <algorithm>
#include <cmath>

#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr int kRoughIterations = 3;  ///< before edges are judged
/// Keyframes that see about the same: camera centres nearer than this share of the depth, and turned by less.
constexpr double kNearDistance = 0.4, kNearDegrees = 30, kAboutAsNear = 0.5;
/// A keyframe that bundle adjustment moves by more (share of its depth; degrees) went astray.
constexpr double kLargestJump = 0.1, kLargestTurn = 5;
constexpr double kSameReadout = 2e-4;  ///< s; smaller changes are not worth moving all points

/// Whether tracking told how well it knows the motion from the parent.
bool hasInformation(const MapKeyframe& keyframe) {
    return keyframe.parent_information.allFinite() &&
           (keyframe.parent_information.diagonal().array() > 0).all();
}

}  // namespace

LocalMapper::LocalMapper(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      options_(options),
      graph_(camera, options.fine),
      fuser_(options.sensor),
      adjuster_(options.mapping, options.sensor, camera),
      judge_(options.mapping, options.sensor, camera) {}

std::vector<const MapKeyframe*> LocalMapper::recentOf(const MapKeyframe& newest) const {
    std::vector<const MapKeyframe*> recent;
    for (auto it = keyframes_.rbegin(); it != keyframes_.rend(); ++it) {
        if (it->first < loaded_) break;  // what others have mapped is not refined
        if (it->first >= newest.id || it->second.track != newest.track) continue;
        if (static_cast<int>(recent.size()) >= options_.mapping.window - 1) break;
        recent.push_back(&it->second);
    }
    return recent;
}

void LocalMapper::unpack(MapKeyframe& keyframe) const {
    if (keyframe.size() > 0) return;
    if (const auto packed = packed_.find(keyframe.id); packed != packed_.end())
        static_cast<KeyframeEdges&>(keyframe) = packed->second.unpacked(camera_, options_.sensor);
}

/// Whether the points were moved.
bool LocalMapper::bringToReadout(MapKeyframe& keyframe) const {
    const RowMotion& rows = keyframe.row_motion;
    const double change = std::abs(rows.seconds_per_row - seconds_per_row_) * camera_.height;
    if (keyframe.size() == 0 || change <= kSameReadout) return false;
    setRowMotion(keyframe, rows.at(seconds_per_row_), camera_);
    return true;
}

void LocalMapper::prepare(const std::vector<const MapKeyframe*>& members) {
    for (const MapKeyframe* member : members) {
        MapKeyframe& keyframe = keyframes_.at(member->id);
        unpack(keyframe);
        // What was packed is not what it is now
        if (bringToReadout(keyframe)) packed_.erase(member->id);
    }
}

void LocalMapper::leaveWindow(MapKeyframe& newest) {
    // What the window of the next one begins with
    std::vector<const MapKeyframe*> held = recentOf(newest);
    held.insert(held.begin(), &newest);
    if (static_cast<int>(held.size()) >= options_.mapping.window) held.pop_back();
    for (auto& [id, keyframe] : keyframes_) {
        if (keyframe.size() == 0 || std::find(held.begin(), held.end(), &keyframe) != held.end()) continue;
        // What was unpacked has not changed since
        if (packed_.find(id) == packed_.end()) packed_.emplace(id, PackedKeyframe(keyframe));
        static_cast<KeyframeEdges&>(keyframe) = {};
    }
}

std::vector<const MapKeyframe*> LocalMapper::nearbyOf(const MapKeyframe& keyframe,
                                                      const std::vector<const MapKeyframe*>& recent) const {
    std::vector<std::pair<double, const MapKeyframe*>> found;
    const int end = recent.empty() ? keyframe.id : recent.back()->id;  // the oldest of them
    for (auto it = keyframes_.begin(); it->first < end; ++it) {
        if (it->second.track != keyframe.track) continue;
        const Pose T = it->second.T_world_camera.inverse() * keyframe.T_world_camera;
        const double distance = T.translation().norm() / keyframe.typicalDepth();
        const double degrees = rotationAngle(T) / kDegree;
        if (distance > kNearDistance || degrees > kNearDegrees) continue;
        // About as near, the older is the better: it has less of the drift
        const double apart = distance / kNearDistance + degrees / kNearDegrees;
        found.emplace_back(std::floor(apart / kAboutAsNear), &it->second);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const MapKeyframe*> nearby;
    for (const auto& [score, candidate] : found) {
        if (static_cast<int>(nearby.size()) >= options_.mapping.max_reused) break;
        nearby.push_back(candidate);
    }
    return nearby;
}

LocalMapper::Neighbourhood LocalMapper::neighbourhoodOf(const MapKeyframe& keyframe) const {
    Neighbourhood out{&keyframe, recentOf(keyframe), {}};
    if (options_.mapping.reuse_keyframes) out.nearby = nearbyOf(keyframe, out.recent);
    return out;
}

/// As they are now; what was related before is forgotten.
void LocalMapper::relate(const Neighbourhood& neighbourhood, double radius) {
    graph_.setLinks(neighbourhood.of->id, {});
    graph_.insert(*neighbourhood.of, neighbourhood.recent, radius);
    graph_.insert(*neighbourhood.of, neighbourhood.nearby, radius);
}

/// @param begin, end  of those that may move; those that were loaded stay, too
void LocalMapper::setWindow(const std::vector<const MapKeyframe*>& members, std::size_t begin,
                            std::size_t end) {
    window_.clear();
    for (const MapKeyframe* keyframe : members) {
        const bool is_free = window_.size() >= begin && window_.size() < end && keyframe->id >= loaded_;
        window_.push_back({keyframe, keyframe->T_world_camera, !is_free});
    }
}

/// Of a keyframe in the window; -1: it is not in it.
int LocalMapper::slotOf(int keyframe) const {
    const auto found = std::find_if(window_.begin(), window_.end(), [&](const WindowKeyframe& view) {
        return view.keyframe->id == keyframe;
    });
    return found == window_.end() ? -1 : static_cast<int>(found - window_.begin());
}

std::optional<MapRefusal> LocalMapper::refusalOf(const WindowKeyframe& view, int inliers) const {
    const MapKeyframe& keyframe = *view.keyframe;
    const Pose jump = keyframe.T_world_camera.inverse() * view.T_world_camera;
    const double moved = jump.translation().norm(), degrees = rotationAngle(jump) / kDegree;
    const MapRefusal refusal{MapRefusal::Kind::kFewObservations, keyframe.id, inliers, moved, degrees};
    if (inliers < options_.fine.min_inliers) return refusal;
    const bool sound = view.T_world_camera.isFinite() && degrees <= kLargestTurn &&
                       moved <= kLargestJump * keyframe.typicalDepth();
    if (sound) return std::nullopt;
    return MapRefusal{MapRefusal::Kind::kMovedTooFar, keyframe.id, inliers, moved, degrees};
}

void LocalMapper::addPriors() {
    priors_.clear();
    const double weight = options_.mapping.prior_weight;
    if (weight <= 0) return;
    for (std::size_t to = 0; to < window_.size(); ++to) {
        const MapKeyframe& keyframe = *window_[to].keyframe;
        const int from = slotOf(keyframe.parent);
        if (from < 0 || !hasInformation(keyframe)) continue;
        priors_.push_back(RelativePrior::between(window_, from, static_cast<int>(to),
                                                 keyframe.T_parent_camera, keyframe.parent_information,
                                                 weight));
    }
}

void LocalMapper::learnOf(int id, std::vector<float> found, const RowMotion& rows) {
    const auto known = keyframes_.find(id);
    if (known == keyframes_.end()) return;
    MapKeyframe& keyframe = known->second;
    if (keyframe.found.size() == found.size()) keyframe.found = std::move(found);
    if (keyframe.size() > 0 && !keyframe.row_motion.known()) setRowMotion(keyframe, rows, camera_);
}

void LocalMapper::correct(const Correction& correction) {
    places_.insert(places_.end(), correction.places.begin(), correction.places.end());
    for (const auto& [id, motion] : correction.motions) {
        MapKeyframe& keyframe = keyframes_.at(id);
        keyframe.T_world_camera = motion * keyframe.T_world_camera;
        keyframe.track = keyframes_.at(correction.places.front().from).track;
    }
}

void LocalMapper::load(const KeyframeInfo& info, KeptKeyframe kept) {
    MapKeyframe keyframe;
    keyframe.id = info.id;
    keyframe.T_world_camera = info.T_world_camera;
    keyframe.median_depth = kept.median_depth;
    keyframe.row_motion = kept.row_motion;
    keyframe.found = std::move(kept.found);
    keyframe.verdicts = std::move(kept.verdicts);
    keyframes_.emplace(info.id, std::move(keyframe));
    packed_.emplace(info.id, std::move(kept.points));
    graph_.setLinks(info.id, std::move(kept.links));
    loaded_ = info.id + 1;
}

std::vector<KeptKeyframe> LocalMapper::kept() const {
    std::vector<KeptKeyframe> all;
    for (const auto& [id, keyframe] : keyframes_) {
        const auto packed = packed_.find(id);
        all.push_back({packed == packed_.end() ? PackedKeyframe(keyframe) : packed->second,
                       keyframe.median_depth, keyframe.row_motion, keyframe.found, keyframe.verdicts,
                       graph_.linksOf(id)});
    }
    return all;
}

MapUpdate LocalMapper::insert(MapKeyframe inserted) {
    const int id = inserted.id;
    if (const auto parent = keyframes_.find(inserted.parent); parent != keyframes_.end()) {
        inserted.T_world_camera = parent->second.T_world_camera * inserted.T_parent_camera;
        inserted.track = parent->second.track;
    }
    MapKeyframe& keyframe = keyframes_.emplace(id, std::move(inserted)).first->second;
    const Neighbourhood neighbourhood = neighbourhoodOf(keyframe);
    const std::vector<const MapKeyframe*>& reused = neighbourhood.nearby;
    prepare(neighbourhood.recent);
    prepare(reused);
    relate(neighbourhood, options_.fine.final_radius);

    MapUpdate update;
    update.keyframe = id;
    update.reused = static_cast<int>(reused.size());
    // In the order of time: of fused edges as long, the oldest one is the reference
    std::vector<const MapKeyframe*> members = reused;
    std::sort(members.begin(), members.end(),
              [](const MapKeyframe* a, const MapKeyframe* b) { return a->id < b->id; });
    members.insert(members.end(), neighbourhood.recent.rbegin(), neighbourhood.recent.rend());
    members.push_back(&keyframe);
    setWindow(members, reused.size() + 1, members.size());  // and the oldest of the recent ones
    addPriors();
    if (window_.size() < 2) {
        leaveWindow(keyframe);
        return update;
    }
    fused_ = fuser_.fuse(window_, graph_.clusters(members));
    const int rough = std::min(kRoughIterations, options_.mapping.max_iterations / 2);
    adjuster_.refine(window_, fused_, priors_, rough, reused.empty() ? 0 : kDriftScale);
    judge_.judge(window_, fused_, adjuster_.equations().scale);
    adjuster_.refine(window_, fused_, priors_, options_.mapping.max_iterations - rough);
    takePoses(adjuster_.equations().inliers, update);
    if (!reused.empty() && options_.mapping.joint_refinement && update.refusals.empty())
        update.posterior = posteriorOf(window_, adjuster_.equations(), trackedClusters(), priors_);
    keepVerdicts();
    update.verdicts = keyframe.verdicts;
    leaveWindow(keyframe);
    return update;
}

/// @param inliers  of each keyframe of the window
void LocalMapper::takePoses(const std::vector<int>& inliers, MapUpdate& update) {
    // All are judged before any is put back, else those that moved with one that is refused would be, too
    std::vector<bool> refused(window_.size(), false);
    for (std::size_t slot = 0; slot < window_.size(); ++slot) {
        if (window_[slot].fixed) continue;
        const auto refusal = refusalOf(window_[slot], inliers[slot]);
        if (refusal) update.refusals.push_back(*refusal);
        refused[slot] = refusal.has_value();
    }
    std::map<int, Pose> motions;  // of the world, by keyframe that has moved
    for (std::size_t slot = 0; slot < window_.size(); ++slot) {
        WindowKeyframe& view = window_[slot];
        if (view.fixed) continue;
        MapKeyframe& keyframe = keyframes_.at(view.keyframe->id);
        if (refused[slot]) {
            // It stays beside its parent, which comes before it
            const auto parent = motions.find(keyframe.parent);
            view.T_world_camera =
                parent == motions.end() ? keyframe.T_world_camera : parent->second * keyframe.T_world_camera;
            if (parent == motions.end()) continue;
        }
        motions.emplace(keyframe.id, view.T_world_camera * keyframe.T_world_camera.inverse());
        keyframe.T_world_camera = view.T_world_camera;
        update.poses.emplace_back(keyframe.id, view.T_world_camera);
    }
}

void LocalMapper::keepVerdicts() {
    for (const WindowKeyframe& view : window_) {
        MapKeyframe& keyframe = keyframes_.at(view.keyframe->id);
        keyframe.verdicts.resize(static_cast<std::size_t>(keyframe.image.numEdges()),
                                 EdgeVerdict::kUnconfirmed);
    }
    for (std::size_t edge = 0; edge < fused_.views.size(); ++edge) {
        const auto [first, end] = fused_.observationsOfEdge(edge);
        for (std::size_t k = first; k < end; ++k) {
            const Observation& seen = fused_.observations[k];
            MapKeyframe& keyframe = keyframes_.at(at(window_, seen.slot).keyframe->id);
            at(keyframe.verdicts, at(keyframe.image.edge_of, seen.point)) = fused_.verdicts[edge];
        }
    }
}

/// How tracking numbers each fused edge in the newest keyframe that sees it, which frames are tracked from.
std::vector<std::int32_t> LocalMapper::trackedClusters() const {
    std::vector<std::int32_t> clusters;
    for (std::size_t edge = 0; edge < fused_.views.size(); ++edge) {
        const auto [first, end] = fused_.observationsOfEdge(edge);
        Observation newest = fused_.observations[first];
        for (std::size_t k = first; k < end; ++k)
            if (fused_.observations[k].slot > newest.slot) newest = fused_.observations[k];
        const MapKeyframe& keyframe = *at(window_, newest.slot).keyframe;
        const auto own = static_cast<std::size_t>(at(keyframe.image.edge_of, newest.point));
        // Those of a map that was loaded have no number, and are fixed
        clusters.push_back(own < keyframe.clusters.size() ? keyframe.clusters[own] : -1);
    }
    return clusters;
}

}  // namespace roevo
