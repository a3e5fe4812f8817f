#include "world.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tracking/camera_scale.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

// How far off a tracked camera can be, and how far a lost one can have come
constexpr double kReachDistance = 0.3;       // m
constexpr double kReachTurn = 20 * kDegree;  // rad
constexpr double kTopSpeed = 1.5;            // m/s
constexpr double kTopTurn = 1.5;             // rad/s

// Two keyframes in a row that were recognised agree on where their track belongs
constexpr int kInARow = 3;                // keyframes
constexpr double kAgreedDistance = 0.05;  // m, on a loop
constexpr double kAgreedTurn = 1 * kDegree;
/// Times as much on a join: blurred images put places so far off, twins are much further apart, and where the
/// map sees the place again it puts the rest right.
constexpr double kJoinTolerance = 3;
constexpr double kLeastWait = 0.2;    // s, between looks at frames that are no keyframes
constexpr double kShareWaited = 0.1;  // of the time since the track was begun
constexpr double kDriftSigmas = 10;   // that the camera can be from where it is thought to be
constexpr double kAnywhere = std::numeric_limits<double>::infinity();  // m

/// What a scale of all depths that errs does to a motion: all frames share it, so that no residual shows it.
Matrix6d byScale(const Eigen::Vector3d& motion, double sigma) {
    Matrix6d covariance = Matrix6d::Zero();
    covariance.topLeftCorner<3, 3>() = sigma * sigma * motion * motion.transpose();
    return covariance;
}

}  // namespace

World::World(const PinholeCamera& camera, const OdometryOptions& options, const Tracker& tracker)
    : camera_(camera),
      options_(scaledTo(camera, options)),
      tracker_(tracker),
      mapper_(makeMapper(camera.undistorted(), options_)),
      relocaliser_(camera, options),
      semi_dense_(camera, options) {}

bool World::closesLoops() const {
    return options_.mapping.close_loops && options_.mode == Mode::kBundleAdjustment;
}

bool World::remembersPlaces() const {
    return options_.loss.recognise || closesLoops();
}

std::optional<double> World::load(StoredMap map, bool held) {
    if (!map.camera.seesAs(camera_))
        throw std::runtime_error("the map is of another camera (" + describe(map.camera) + "; now " +
                                 describe(camera_) + ")");
    if (!options_.loss.recognise)
        throw std::runtime_error(
            "a map is of no use with loss.recognise=false: no place is looked for in it");
    loaded_ = static_cast<int>(map.graph.keyframes.size());
    held_ = held;
    if (loaded_ > 0) misplacements_[0].distance = kAnywhere;
    std::optional<double> seconds_per_row;
    for (const KeptKeyframe& keyframe : map.edges)
        if (keyframe.row_motion.known()) seconds_per_row = keyframe.row_motion.seconds_per_row;
    std::vector<KnownPlace> places;
    for (std::size_t id = 0; id < map.places.size(); ++id)
        places.push_back({std::move(map.places[id]), map.edges[id].points, map.edges[id].median_depth,
                          map.edges[id].row_motion});
    relocaliser_.load(std::move(places));
    mapper_->load(map.graph.keyframes, std::move(map.edges));
    semi_dense_.load(std::move(map.surfaces));
    trajectory_.load(std::move(map.graph), held);
    return seconds_per_row;
}

StoredMap World::map() {
    if (held_) throw std::logic_error("a map that is only used to localise is not written");
    if (!remembersPlaces())
        throw std::runtime_error("there is no map with loss.recognise=false: places are not remembered");
    StoredMap map;
    map.camera = camera_;
    map.graph = finalTrajectory().graph();
    map.edges = mapper_->kept();
    const std::vector<KnownPlace>& places = relocaliser_.places();
    for (std::size_t id = 0; id < places.size(); ++id) {
        map.places.push_back(places[id].points);
        if (id < map.edges.size()) continue;
        const KnownPlace& place = places[id];
        const std::vector<float> found(static_cast<std::size_t>(place.edges.numEdges()), -1);
        map.edges.push_back({place.edges, place.median_depth, place.row_motion, found, {}, {}});
    }
    map.surfaces = semi_dense_.keyframes();
    map.surfaces.resize(map.places.size());
    // Tracks that were not joined are in worlds of their own
    const std::vector<int> tracks = trajectory_.tracks();
    std::vector<int> sizes(tracks.size());
    for (const int track : tracks) ++at(sizes, track);
    const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
    std::vector<bool> kept;
    for (const int track : tracks) kept.push_back(track == (loaded_ > 0 ? 0 : largest));
    keepOnly(kept, map);
    leaveOutCovered(options_.keyframe, loaded_, map);
    return map;
}

EdgeMap World::inThisWorld(EdgeMap edges) const {
    eraseIf(edges, [&](const MapEdge& edge) { return edge.keyframe_id < unrelated(); });
    return edges;
}

void World::advance(double timestamp, double seconds_per_row) {
    timestamp_ = timestamp;
    seconds_per_row_ = seconds_per_row;
    for (const MapUpdate& update : mapper_->due(timestamp, change_.ms.waiting)) takeUpdate(update);
    if (recognised_at_ && timestamp >= *recognised_at_) recognise();
    if (reference_) reference_->setRowMotion(reference_->row_motion.at(seconds_per_row));
}

/// Adds how far the camera has moved, as it is seen now.
void World::noteMotion(const Pose& before, const Pose& after) {
    change_.map_correction += (after.translation() - before.translation()).norm();
    change_.map_turn += rotationAngle(after * before.inverse());
}

void World::takeUpdate(const MapUpdate& update) {
    const Pose before = trajectory_.lastPose();
    trajectory_.apply(update);
    noteMotion(before, trajectory_.lastPose());
    change_.ms.mapping += update.milliseconds;
    change_.ms.mapping_cpu += update.cpu_milliseconds;
    change_.map_refusals.insert(change_.map_refusals.end(), update.refusals.begin(), update.refusals.end());
    if (update.keyframe == reference_->id && !update.verdicts.empty())
        reference_->weaken(update.verdicts, options_.mapping.pseudo_weight);
}

Fault World::beginTrack(const Frame& frame, const RowMotion& rows, const Pose& T_world_camera,
                        const Matrix6d& covariance, double lost_for) {
    Fault fault;
    auto fresh = make(frame, rows, options_.fine.min_inliers, fault);
    if (!fresh) return fault;
    numberEdges(*fresh, nullptr, {}, next_cluster_);
    recognise();
    Reach misplaced;
    if (reference_) {
        const Reach before = misplacementOf(reference_->id), drift = driftOf(reference_->id);
        misplaced = {before.distance + drift.distance + kTopSpeed * lost_for,
                     before.turn + kTopTurn * lost_for};
    }
    fresh->id = trajectory_.beginTrack(frame.timestamp(), T_world_camera, covariance);
    misplacements_[fresh->id] = misplaced;
    track_begun_at_ = timestamp_;
    adopt(std::move(fresh), frame, RelativePose());
    return {};
}

void World::noteTrack() {
    if (localised_ || trajectory_.beginOfTrack(reference_->id) >= loaded_) return;
    localised_ = true;
    for (auto& [track, misplaced] : misplacements_) misplaced.distance = track == 0 ? 0 : kAnywhere;
}

Reach World::misplacementOf(int keyframe) const {
    const int begin = trajectory_.beginOfTrack(keyframe);
    const auto found = misplacements_.find(begin);
    if (found == misplacements_.end()) return {};
    const auto& [distance, turn] = found->second;
    const Pose since = trajectory_.keyframePose(begin).inverse() * trajectory_.keyframePose(keyframe);
    return {distance + std::min(2.0, turn) * since.translation().norm(), turn};
}

Reach World::driftOf(int keyframe) const {
    const Matrix6d drift = trajectory_.drift(trajectory_.beginOfTrack(keyframe), keyframe);
    return {kDriftSigmas * worstSigma(drift.topLeftCorner<3, 3>()),
            kDriftSigmas * worstSigma(drift.bottomRightCorner<3, 3>())};
}

Matrix6d World::covariance(const RelativePose& pose) const {
    const Pose& begin = trajectory_.keyframePose(trajectory_.beginOfTrack(pose.keyframe));
    return trajectory_.worldCovariance(pose) +
           byScale(trajectory_.worldPose(pose).translation() - begin.translation(),
                   options_.sensor.depth_scale_sigma);
}

Matrix6d World::motionCovariance(std::size_t from, std::size_t to) const {
    const Pose motion = trajectory_.motion(from, to);
    if (from == to) return Matrix6d::Zero();
    return trajectory_.motionCovariance(from, to) +
           byScale(motion.linear().transpose() * motion.translation(), options_.sensor.depth_scale_sigma);
}

Whereabouts World::whereabouts(const RelativePose& pose, double lost_for) const {
    const int keyframe = pose.keyframe;
    if (keyframe < 0) return {Pose(), [](int) { return Reach{kAnywhere, kAnywhere}; }, kAnywhere};
    const Reach drift = driftOf(keyframe), misplaced = misplacementOf(keyframe);
    const double unseen = kReachDistance + kTopSpeed * lost_for;
    const Reach within_track{unseen + drift.distance, kReachTurn + kTopTurn * lost_for + drift.turn};
    const auto reach = [this, keyframe, within_track, misplaced](int other) {
        if (trajectory_.areOfOneTrack(other, keyframe)) return within_track;
        const Reach there = misplacementOf(other);
        return Reach{within_track.distance + misplaced.distance + there.distance,
                     within_track.turn + misplaced.turn + there.turn};
    };
    // What was lost before is not counted while it is lost again
    return {trajectory_.worldPose(pose), reach, lost_for > 0 ? unseen : unseen + misplaced.distance};
}

/// What older keyframe the newest one shows.
void World::recognise() {
    if (!std::exchange(recognised_at_, std::nullopt)) return;
    const RelativePose newest{reference_->id, Pose::Identity(), {}};
    const Whereabouts near = whereabouts(newest, 0);
    if (options_.loss.recognise && joinElsewhere(near)) return;
    bool drifted = false;
    for (const RelativePose& alike : relocaliser_.resembled(trajectory_, near)) {
        if (isWithinReach(alike))
            trajectory_.relate(alike.keyframe, newest.keyframe);
        else
            drifted = true;
    }
    if (!drifted) return;
    const auto place = relocaliser_.recognised(Among::kOwnTrack, trajectory_, near);
    if (!place) return;
    if (isWithinReach(place->pose))  // by its edges, which tell better than its points
        trajectory_.relate(place->pose.keyframe, newest.keyframe);
    else
        closeLoop({newest.keyframe, *place});
}

/// Whether the map can relate the edges of the place by itself, where the newest keyframe is thought to be.
bool World::isWithinReach(const RelativePose& pose) const {
    return imageMotion(trajectory_.worldPose(pose).inverse(),
                       trajectory_.keyframePose(reference_->id).inverse(), camera_.fx,
                       reference_->typicalDepth()) <= options_.fine.final_radius;
}

/// A track that was begun after a loss is moved to where its newest keyframe is recognised.
bool World::joinElsewhere(const Whereabouts& near) {
    const auto place = relocaliser_.recognised(Among::kOtherTracks, trajectory_, near);
    if (!place) return false;
    const Look newest{reference_->id, *place};
    const auto before = agreeing(join_look_, newest, kJoinTolerance);
    if (!place->sure && !before) return false;
    const bool earlier = !place->sure && before->place.likeness > place->likeness;
    join(earlier ? *before : newest);
    return true;
}

void World::join(const Look& look) {
    const Pose before = trajectory_.lastPose();
    mapper_->correct(trajectory_.join(look.keyframe, look.place.pose));
    noteMotion(before, trajectory_.lastPose());
    change_.joined_at = look.place.pose.keyframe;
    join_look_.reset();
    noteTrack();
}

/// The look before, if this one agrees with it on where the track belongs. From now on this one is the look
/// before.
std::optional<World::Look> World::agreeing(std::optional<Look>& look, const Look& newest,
                                           double tolerance) const {
    const auto before = std::exchange(look, newest);
    if (!before || newest.keyframe - before->keyframe > kInARow) return std::nullopt;
    if (!trajectory_.areOfOneTrack(before->keyframe, newest.keyframe) ||
        !trajectory_.areOfOneTrack(before->place.pose.keyframe, newest.place.pose.keyframe))
        return std::nullopt;
    const auto motionOf = [&](const Look& look) {
        return trajectory_.worldPose(look.place.pose) * trajectory_.keyframePose(look.keyframe).inverse();
    };
    const Pose& T_world_newest = trajectory_.keyframePose(newest.keyframe);
    const Pose apart = (motionOf(*before) * T_world_newest).inverse() * motionOf(newest) * T_world_newest;
    if (apart.translation().norm() > tolerance * kAgreedDistance ||
        rotationAngle(apart) > tolerance * kAgreedTurn)
        return std::nullopt;
    return before;
}

/// Where the map cannot relate the edges of a place that is seen again, since the camera has drifted too far.
void World::closeLoop(const Look& newest) {
    const auto first = agreeing(loop_look_, newest, 1);
    if (!first) return;
    const Pose before = trajectory_.lastPose();
    const Correction correction =
        trajectory_.closeLoop({{first->keyframe, first->place.pose}, {newest.keyframe, newest.place.pose}});
    if (correction.motions.empty()) return;
    mapper_->correct(correction);
    noteMotion(before, trajectory_.lastPose());
    change_.closed_at = newest.place.pose.keyframe;
    loop_look_.reset();
}

std::optional<RelativePose> World::find(const Frame& frame, const RelativePose& last, double since_measured) {
    if (!options_.loss.recognise) return std::nullopt;
    return relocaliser_.find(frame, Among::kAllTracks, trajectory_, whereabouts(last, since_measured));
}

bool World::lookForOtherTrack(const Frame& frame, const RelativePose& pose) {
    // The newest keyframe is looked up itself
    if (!options_.loss.recognise || recognised_at_ || timestamp_ < next_look_) return false;
    waitForNextLook();
    if (!hasOtherTracks(trajectory_.tracks())) return false;
    return relocaliser_.find(frame, Among::kOtherTracks, trajectory_, whereabouts(pose, 0)).has_value();
}

void World::waitForNextLook() {
    next_look_ = timestamp_ + std::max(kLeastWait, kShareWaited * (timestamp_ - track_begun_at_));
}

std::vector<MapRefusal> World::refineAll() {
    if (!reference_) return {};
    recognise();
    std::vector<MapRefusal> before = std::exchange(change_.map_refusals, {});
    for (const MapUpdate& update : mapper_->refineAll()) takeUpdate(update);
    return std::exchange(change_.map_refusals, std::move(before));
}

std::vector<KeyframeInfo> World::keyframes() const {
    std::vector<KeyframeInfo> all = finalTrajectory().keyframes();
    all.erase(all.begin(), all.begin() + unrelated());
    return all;
}

Trajectory World::finalTrajectory() const {
    Trajectory poses = trajectory_;
    for (const MapUpdate& update : mapper_->outstanding()) poses.apply(update);
    return poses;
}

}  // namespace roevo
