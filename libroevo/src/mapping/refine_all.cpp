// All keyframes at once, when a recording ends or there is time.
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "mapping/local_mapper.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

/// Of recognised places, against all points: as that of tracked motions, because edges mostly relate them,
/// too.
constexpr double kPlaceWeight = 0.15;
/// px of image motion, mean of the keyframes: a round that moves them less is the last. Edges that are
/// related anew move them by half of that for ever.
constexpr double kHardlyMoved = 0.25;

}  // namespace

/// They hold what is too far apart for its edges to be related, and what too few edges relate.
void LocalMapper::addRecognisedPlaces() {
    for (const PoseConstraint& place : places_) {
        const int from = slotOf(place.from), to = slotOf(place.to);
        const Matrix6d information = place.covariance.inverse();
        if (from < 0 || to < 0 || !information.allFinite()) continue;
        priors_.push_back(
            RelativePrior::between(window_, from, to, place.T_from_to, information, kPlaceWeight));
    }
}

/// Relates and fuses edges anew at the poses of each round: where a loop was closed or a track was joined,
/// they were not related yet. What moves is held where it is related to others, before it and after it.
/// @param begin, end  of the keyframes that move: neither the first of the track nor any that was loaded
void LocalMapper::refineTogether(const std::vector<const MapKeyframe*>& track, std::size_t begin,
                                 std::size_t end, BundleAdjuster& adjuster, MapUpdate& update) {
    const int first_id = track[begin]->id, last_id = track[end - 1]->id;
    const auto follow = std::min(track.size(), end + static_cast<std::size_t>(options_.mapping.window));
    std::map<int, const MapKeyframe*> related{{track[begin - 1]->id, track[begin - 1]}};
    std::vector<Neighbourhood> neighbourhoods;
    for (std::size_t k = begin; k < follow; ++k) {
        related.emplace(track[k]->id, track[k]);
        neighbourhoods.push_back(neighbourhoodOf(*track[k]));
        if (k >= end) continue;
        for (const auto* others : {&neighbourhoods.back().recent, &neighbourhoods.back().nearby})
            for (const MapKeyframe* other : *others) related.emplace(other->id, other);
    }
    for (const PoseConstraint& place : places_)
        for (const auto& [id, other] : {std::pair(place.from, place.to), {place.to, place.from}})
            if (const auto found = keyframes_.find(other); found != keyframes_.end() &&
                                                           found->second.track == track[begin]->track &&
                                                           id >= first_id && id <= last_id)
                related.emplace(other, &found->second);
    std::vector<const MapKeyframe*> members;
    for (const auto& [id, keyframe] : related) members.push_back(keyframe);
    const auto slots = static_cast<std::size_t>(std::distance(related.begin(), related.find(first_id)));
    prepare(members);
    MapUpdate last;
    for (int round = 0; round < options_.mapping.final_rounds; ++round) {
        // Wide at first, as tracking is
        const double radius = round == 0 ? options_.fine.search_radius : options_.fine.final_radius;
        for (const Neighbourhood& neighbourhood : neighbourhoods) relate(neighbourhood, radius);
        setWindow(members, slots, slots + end - begin);
        const std::vector<WindowKeyframe> before_round = window_;
        addPriors();
        addRecognisedPlaces();
        fused_ = fuser_.fuse(window_, graph_.clusters(members));
        takeKeptVerdicts(window_, fused_);
        last = {};
        adjuster.refine(window_, fused_, priors_, options_.mapping.max_iterations,
                        round == 0 ? kDriftScale : 0);
        takePoses(adjuster.equations().inliers, last);
        double moved = 0;
        for (std::size_t slot = 0; slot < members.size(); ++slot)
            moved += imageMotion(members[slot]->T_world_camera.inverse(),
                                 before_round[slot].T_world_camera.inverse(), camera_.fx,
                                 members[slot]->typicalDepth());
        if (round > 0 && moved < kHardlyMoved * static_cast<double>(end - begin)) break;
    }
    // The part before had them, too
    eraseIf(update.refusals, [&](const MapRefusal& refusal) {
        const int slot = slotOf(refusal.keyframe);
        return slot >= 0 && !at(window_, slot).fixed;
    });
    update.refusals.insert(update.refusals.end(), last.refusals.begin(), last.refusals.end());
    // Where they are now: what a round left as it was may have moved in the one before
    for (const WindowKeyframe& view : window_)
        if (!view.fixed) update.poses.emplace_back(view.keyframe->id, view.keyframe->T_world_camera);
}

MapUpdate LocalMapper::refineAll(std::size_t most_together) {
    MapUpdate update;
    if (keyframes_.empty()) return update;
    update.keyframe = keyframes_.rbegin()->first + 1;  // it knows of all that there are
    if (options_.mapping.final_rounds <= 0) return update;
    std::map<int, std::vector<const MapKeyframe*>> tracks;
    for (const auto& [id, keyframe] : keyframes_) tracks[keyframe.track].push_back(&keyframe);
    // Here the step must be right in directions that few points hold
    BundleAdjuster adjuster(options_.mapping, options_.sensor, camera_,
                            std::numeric_limits<std::size_t>::max());
    for (const auto& [id, track] : tracks) {
        const auto isOwn = [&](const MapKeyframe* keyframe) { return keyframe->id >= loaded_; };
        const auto loaded =
            static_cast<std::size_t>(std::find_if(track.begin(), track.end(), isOwn) - track.begin());
        std::size_t end = 0;
        for (std::size_t begin = std::max<std::size_t>(1, loaded); begin < track.size() && end < track.size();
             begin += most_together / 2) {
            end = std::min(track.size(), begin + most_together);
            refineTogether(track, begin, end, adjuster, update);
            leaveWindow(keyframes_.rbegin()->second);
        }
    }
    return update;
}

}  // namespace roevo
