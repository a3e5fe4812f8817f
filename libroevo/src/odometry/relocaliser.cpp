#include "relocaliser.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>

#include "tracking/camera_scale.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr std::size_t kCandidates = 5;  ///< keyframes whose points are compared
constexpr std::size_t kRegistered = 3;  ///< of them, those whose edges are
// Poses that are further apart are different places
constexpr double kSamePlace = 0.3;               ///< m
constexpr double kSameDirection = 15 * kDegree;  ///< rad
// A place that is merely plausible is believed within so short a reach (what a hand goes in 2 s): doors 4 m
// apart repeat. One with weak evidence is worth a second look where the camera is about there anyway
constexpr double kShortReach = 3.5, kAboutThere = 1;  ///< m
/// Of the edges, both ways: fewer, as of a blurred image, tell the place and not the pose.
constexpr double kLeastMatched = 0.25;
RelativePose poseOf(const EdgeRegistration& found, int keyframe) {
    RelativePose pose{keyframe, found.T_frame_keyframe.inverse(), {found.covariance, {}}};
    addErrorsFromElsewhere(pose.uncertainty);
    return pose;
}

}  // namespace

bool hasOtherTracks(const std::vector<int>& tracks) {
    return std::any_of(tracks.begin(), tracks.end(), [&](int track) { return track != tracks.back(); });
}

bool Whereabouts::allow(const Pose& T_world_there, int keyframe) const {
    const Pose apart = T_world_camera.inverse() * T_world_there;
    const Reach most = reach(keyframe);
    return std::isfinite(most.distance) && apart.translation().norm() <= most.distance &&
           rotationAngle(apart) <= most.turn;
}

Relocaliser::Relocaliser(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      ideal_(camera.undistorted()),
      options_(scaledTo(camera, options)),
      describer_(camera),
      registrar_(camera, options, true),
      confirmer_(camera, options, false) {}

void Relocaliser::load(std::vector<KnownPlace> places) {
    places_ = std::move(places);
    for (std::size_t id = 0; id < places_.size(); ++id)
        index_.insert(static_cast<int>(id), places_[id].points);
}

const std::vector<KnownPlace>& Relocaliser::places() {
    collect();
    return places_;
}

void Relocaliser::add(const Keyframe& keyframe, const Frame& frame, std::vector<Rgb> colours,
                      std::vector<int> tracks, int end) {
    collect();
    Keyframe copy;  // of what is remembered
    copy.id = keyframe.id;
    copy.edges = keyframe.edges;
    copy.median_depth = keyframe.median_depth;
    copy.row_motion = keyframe.row_motion;
    auto seen = std::make_unique<Frame>();
    if (end > 0 || hasOtherTracks(tracks)) {
        seen->edges = frame.edges;
        seen->images.depth = frame.images.depth.clone();
        seen->images.mask = frame.images.mask.clone();
    }
    seen->pyramid.build(frame.pyramid.level(0).clone(), 1);
    auto describing = [this, copy = std::move(copy), seen = std::move(seen), colours = std::move(colours),
                       tracks = std::move(tracks), end]() mutable {
        return describe(std::move(copy), std::move(seen), colours, tracks, end);
    };
    // In a thread if there are several, and if one can be started. An attempt that fails must not use it up
    const auto kept = std::make_shared<decltype(describing)>(std::move(describing));
    const auto job = [kept] { return (*kept)(); };
    const auto anyhow = std::launch::async | std::launch::deferred;
    at_work_ = std::async(threadCount(options_.threads) > 1 ? anyhow : std::launch::deferred, job);
}

Relocaliser::Described Relocaliser::describe(Keyframe keyframe, std::unique_ptr<Frame> frame,
                                             const std::vector<Rgb>& colours, const std::vector<int>& tracks,
                                             int end) {
    Described out;
    KnownPlace& place = out.place;
    const cv::Mat& grey = frame->pyramid.level(0);
    place.points = describer_.describe(keyframe.edges, grey);
    place.edges = PackedKeyframe(toMapKeyframe(keyframe, colours, ideal_, options_.mapping.max_points));
    place.median_depth = keyframe.median_depth;
    place.row_motion = keyframe.row_motion;
    const auto isOwn = [&](int id) { return at(tracks, id) == tracks.back(); };
    if (hasOtherTracks(tracks))
        out.elsewhere = lookUp(place.points, keyframe.id, [&](int id) { return !isOwn(id); });
    if (end > 0) out.alike = lookUp(place.points, keyframe.id, [&](int id) { return id < end && isOwn(id); });
    if (out.alike.empty() && out.elsewhere.empty()) return out;
    frame->grid.build(frame->edges, grey.cols, grey.rows);
    out.frame = std::move(frame);
    out.edges = std::move(keyframe.edges);
    return out;
}

void Relocaliser::collect() {
    if (failure_) std::rethrow_exception(failure_);
    if (!at_work_.valid()) return;
    try {
        newest_ = at_work_.get();
        places_.push_back(std::move(newest_.place));
        index_.insert(static_cast<int>(places_.size()) - 1, places_.back().points);
    } catch (...) {  // places would have other keyframes' ids from now on
        failure_ = std::current_exception();
        throw;
    }
}

Keyframe Relocaliser::unpacked(int id) const {
    const KnownPlace& place = at(places_, id);
    KeyframeEdges edges = place.edges.unpacked(ideal_, options_.sensor);
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.edges.image = std::move(edges.image);
    keyframe.edges.points = std::move(edges.points);
    keyframe.edges.weight = std::move(edges.weight);
    keyframe.edges.correction.assign(keyframe.edges.size(), 0);
    for (int e = 0; e < keyframe.edges.image.numEdges(); ++e) keyframe.clusters.push_back(e);
    keyframe.median_depth = place.median_depth;
    keyframe.row_motion = place.row_motion;
    return keyframe;
}

EdgePoints3D Relocaliser::lifted(const Frame& frame, const RowMotion& rows) const {
    if (frame.images.depth.empty()) return {};
    return liftEdges(frame.edges, frame.images.depth, camera_, rows, options_.edges, options_.sensor);
}

Likeness Relocaliser::likenessOf(int keyframe, const Frame& frame, const Pose& T_frame_keyframe) {
    return describer_.compare(at(places_, keyframe).points, T_frame_keyframe, frame.pyramid.level(0),
                              frame.images);
}

std::optional<RelativePose> Relocaliser::confirm(const Keyframe& keyframe, const Frame& frame,
                                                 const Pose& T_keyframe_camera, const RowMotion& rows) {
    const EdgePoints3D edges = lifted(frame, rows);
    if (edges.size() == 0) return std::nullopt;
    const EdgeRegistration found =
        confirmer_.registerEdges(keyframe, frame, edges, T_keyframe_camera.inverse(), rows);
    collect();
    if (!confirms(found, likenessOf(keyframe.id, frame, found.T_frame_keyframe))) return std::nullopt;
    return poseOf(found, keyframe.id);
}

std::vector<RelativePose> Relocaliser::resembled(const Trajectory& trajectory,
                                                 const Whereabouts& whereabouts) {
    collect();
    std::vector<Alike> possible;
    std::vector<RelativePose> poses;
    for (const auto& [points, id] : newest_.alike) {
        const RelativePose pose{id, points.T_candidate_query, {}};
        if (!whereabouts.allow(trajectory.worldPose(pose), id)) continue;
        possible.emplace_back(points, id);
        poses.push_back(pose);
    }
    newest_.alike = std::move(possible);
    return poses;
}

std::optional<RecognisedPlace> Relocaliser::recognised(Among tracks, const Trajectory& trajectory,
                                                       const Whereabouts& whereabouts) {
    collect();
    const std::vector<Alike>& alike = tracks == Among::kOwnTrack ? newest_.alike : newest_.elsewhere;
    if (alike.empty()) return std::nullopt;
    return surest(registered(alike, *newest_.frame, newest_.edges, places_.back().row_motion), trajectory,
                  whereabouts);
}

std::optional<RelativePose> Relocaliser::find(const Frame& frame, Among tracks, const Trajectory& trajectory,
                                              const Whereabouts& whereabouts) {
    collect();
    const EdgePoints3D edges = lifted(frame, RowMotion());
    if (edges.size() == 0) return std::nullopt;
    const PlacePoints points = describer_.describe(edges, frame.pyramid.level(0));
    const std::vector<int> track_of = trajectory.tracks();
    const auto wanted = [&](int id) {
        const bool own = at(track_of, id) == track_of.back();
        return tracks == Among::kAllTracks || own == (tracks == Among::kOwnTrack);
    };
    const std::vector<Alike> alike = lookUp(points, -1, wanted);
    const auto found = surest(registered(alike, frame, edges, RowMotion()), trajectory, whereabouts);
    if (!found || !found->sure) return std::nullopt;
    return found->pose;
}

/// Keyframes whose points look alike, those with the most agreeing points first.
std::vector<Relocaliser::Alike> Relocaliser::lookUp(const PlacePoints& points, int query_id,
                                                    const std::function<bool(int)>& wanted) {
    std::vector<Alike> alike;
    for (const PlaceCandidate& candidate : index_.query(points, kCandidates, wanted)) {
        const PlacePoints& place = at(places_, candidate.id).points;
        const auto found = verifyPlaces(points, query_id, place, candidate.id, options_.sensor);
        if (found) alike.emplace_back(*found, candidate.id);
    }
    std::stable_sort(alike.begin(), alike.end(),
                     [](const Alike& a, const Alike& b) { return a.first.inliers > b.first.inliers; });
    return alike;
}

/// Those whose edges do not contradict.
std::vector<RecognisedPlace> Relocaliser::registered(const std::vector<Alike>& alike, const Frame& frame,
                                                     const EdgePoints3D& edges, const RowMotion& rows) {
    std::vector<RecognisedPlace> recognised;
    for (std::size_t k = 0; k < std::min(kRegistered, alike.size()); ++k) {
        const auto& [of_points, id] = alike[k];
        const EdgeRegistration found =
            registrar_.registerEdges(unpacked(id), frame, edges, of_points.T_candidate_query.inverse(), rows);
        if (!found.held) continue;
        const Likeness likeness = likenessOf(id, frame, found.T_frame_keyframe);
        const Evidence evidence = evidenceOf(of_points, found, likeness);
        if (evidence == Evidence::kNone) continue;
        const double matched = std::min(found.keyframe_matched, found.frame_matched);
        recognised.push_back({poseOf(found, id), evidence, likeness.share(), matched, false});
    }
    return recognised;
}

std::optional<RecognisedPlace> Relocaliser::surest(const std::vector<RecognisedPlace>& recognised,
                                                   const Trajectory& trajectory,
                                                   const Whereabouts& whereabouts) {
    if (recognised.empty()) return std::nullopt;
    const auto best = [](const std::vector<RecognisedPlace>& among) {
        return *std::max_element(
            among.begin(), among.end(), [](const RecognisedPlace& a, const RecognisedPlace& b) {
                return std::pair(a.evidence, a.likeness) < std::pair(b.evidence, b.likeness);
            });
    };
    const auto worldPose = [&](const RecognisedPlace& r) { return trajectory.worldPose(r.pose); };
    const auto trackOf = [&](const RecognisedPlace& r) { return trajectory.beginOfTrack(r.pose.keyframe); };
    // What the camera cannot have reached is believed only if it is like no other place, and is no rival
    std::vector<RecognisedPlace> possible;
    for (const RecognisedPlace& r : recognised)
        if (whereabouts.allow(worldPose(r), r.pose.keyframe)) possible.push_back(r);
    const std::vector<RecognisedPlace>& among = possible.empty() ? recognised : possible;
    RecognisedPlace likeliest = best(among);
    const bool holds = likeliest.matched >= kLeastMatched;
    likeliest.sure = holds && likeliest.evidence == Evidence::kConclusive;
    if (likeliest.sure) return likeliest;
    const Evidence rivals = std::min(likeliest.evidence, Evidence::kPlausible);
    const bool has_rival = std::any_of(among.begin(), among.end(), [&](const RecognisedPlace& other) {
        // The same place may be in two tracks
        if (other.evidence < rivals || trackOf(other) != trackOf(likeliest)) return false;
        const Pose apart = worldPose(likeliest).inverse() * worldPose(other);
        return apart.translation().norm() > kSamePlace || rotationAngle(apart) > kSameDirection;
    });
    if (has_rival) return std::nullopt;
    const bool is_possible = !possible.empty();
    const Evidence needed = whereabouts.unseen <= kShortReach ? Evidence::kPlausible : Evidence::kStrong;
    likeliest.sure = holds && is_possible && likeliest.evidence >= needed;
    const bool is_about_there =
        is_possible && whereabouts.reach(likeliest.pose.keyframe).distance <= kAboutThere;
    if (!likeliest.sure && !is_about_there && likeliest.evidence < Evidence::kFitting) return std::nullopt;
    return likeliest;
}

}  // namespace roevo
