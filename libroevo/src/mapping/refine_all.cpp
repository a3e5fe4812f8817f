// All keyframes at once, when a recording ends or there is time.
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "mapping/local_mapper.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

/// Keyframes of a long track that are refined together, because the equations are dense; and how many of them
/// are those that were before.
constexpr int kMostTogether = 200, kMostFixed = 100;
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
/// they were not related yet. @param fixed  members, the first ones
void LocalMapper::refineTogether(const std::vector<const MapKeyframe*>& part, std::size_t fixed,
                                 BundleAdjuster& adjuster, MapUpdate& update) {
    if (part.back()->id < loaded_) return;  // and so are all before it
    std::vector<Neighbourhood> neighbourhoods;
    std::map<int, const MapKeyframe*> before;
    for (std::size_t k = fixed; k < part.size(); ++k) {
        if (part[k]->id < loaded_) continue;
        neighbourhoods.push_back(neighbourhoodOf(*part[k]));
        for (const auto* others : {&neighbourhoods.back().recent, &neighbourhoods.back().nearby})
            for (const MapKeyframe* other : *others)
                if (other->id < part.front()->id) before[other->id] = other;
    }
    std::vector<const MapKeyframe*> members;
    for (const auto& [id, keyframe] : before) members.push_back(keyframe);
    fixed += members.size();
    members.insert(members.end(), part.begin(), part.end());
    prepare(members);
    MapUpdate last;
    for (int round = 0; round < options_.mapping.final_rounds; ++round) {
        // Wide at first, as tracking is
        const double radius = round == 0 ? options_.fine.search_radius : options_.fine.final_radius;
        for (const Neighbourhood& neighbourhood : neighbourhoods) relate(neighbourhood, radius);
        setWindow(members, fixed);
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
        if (round > 0 && moved < kHardlyMoved * static_cast<double>(members.size())) break;
    }
    update.refusals.insert(update.refusals.end(), last.refusals.begin(), last.refusals.end());
    // Where they are now: what a round left as it was may have moved in the one before
    for (const WindowKeyframe& view : window_)
        if (!view.fixed) update.poses.emplace_back(view.keyframe->id, view.keyframe->T_world_camera);
}

MapUpdate LocalMapper::refineAll() {
    MapUpdate update;
    if (keyframes_.empty()) return update;
    update.keyframe = keyframes_.rbegin()->first + 1;  // it knows of all that there are
    if (options_.mapping.final_rounds <= 0) return update;
    std::map<int, std::vector<const MapKeyframe*>> tracks;
    for (const auto& [id, keyframe] : keyframes_) tracks[keyframe.track].push_back(&keyframe);
    // Here the step must be right in directions that few points hold
    BundleAdjuster adjuster(options_.mapping, options_.sensor, camera_,
                            std::numeric_limits<std::size_t>::max());
    for (const auto& [track, members] : tracks) {
        std::size_t fixed = 1;
        for (auto begin = members.begin(); members.end() - begin > static_cast<int>(fixed);
             begin += kMostTogether - kMostFixed, fixed = kMostFixed) {
            const auto end = begin + std::min<std::ptrdiff_t>(members.end() - begin, kMostTogether);
            refineTogether({begin, end}, fixed, adjuster, update);
            leaveWindow(keyframes_.rbegin()->second);
            if (end == members.end()) break;
        }
    }
    return update;
}

}  // namespace roevo
