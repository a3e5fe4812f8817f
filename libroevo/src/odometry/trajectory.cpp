#include "trajectory.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace roevo {
namespace {

constexpr double kMostContradiction = 50;  // squared sigmas, of a loop
constexpr double kRecent = 4.25;  // s; of frames since then it is kept which edges their errors come from

/// Puts what these clusters do to what is independent.
template <class Chosen>
void forget(PoseUncertainty& uncertainty, Chosen&& chosen) {
    auto& edges = uncertainty.influences;
    const auto gone = std::stable_partition(edges.begin(), edges.end(),
                                            [&](const EdgeInfluence& edge) { return !chosen(edge.cluster); });
    for (auto it = gone; it != edges.end(); ++it)
        uncertainty.independent += it->moved * it->moved.transpose();
    edges.erase(gone, edges.end());
    if (edges.empty()) edges.shrink_to_fit();
}

void forgetAll(PoseUncertainty& uncertainty) {
    forget(uncertainty, [](std::int32_t) { return true; });
}

/// Where posteriors made a keyframe better known than one before it, differences are no covariances.
Matrix6d positivePart(const Matrix6d& difference) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(difference);
    return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() *
           axes.eigenvectors().transpose();
}

/// For one more, so that adding it cannot fail.
template <class Items>
void makeRoom(Items& items) {
    if (items.size() == items.capacity()) items.reserve(2 * items.size() + 1);
}

}  // namespace

void Trajectory::load(KeyframeGraph graph, bool held) {
    keyframes_ = std::move(graph.keyframes);
    links_ = std::move(graph.links);
    for (const Matrix6d& covariance : graph.covariances) in_world_.push_back({covariance, {}});
    related_ = std::move(graph.related);
    loops_ = std::move(graph.loops);
    findTracks();
    loaded_ = static_cast<int>(keyframes_.size());
    if (held) held_ = loaded_;
}

KeyframeGraph Trajectory::graph() const {
    KeyframeGraph graph{keyframes_, links_, {}, related_, loops_};
    for (RelativePose& link : graph.links) link.uncertainty = {link.covariance(), {}};
    for (const PoseUncertainty& known : in_world_) graph.covariances.push_back(known.covariance());
    return graph;
}

int Trajectory::beginTrack(double timestamp, const Pose& T_world_camera, const Matrix6d& covariance) {
    const Matrix6d to_camera = turnedBy(T_world_camera.linear().transpose());
    const PoseUncertainty uncertainty{to_camera * covariance * to_camera.transpose(), {}};
    return add(timestamp, T_world_camera, {-1, T_world_camera, uncertainty}, uncertainty);
}

int Trajectory::addKeyframe(double timestamp, const RelativePose& pose,
                            const std::vector<std::int32_t>& clusters) {
    RelativePose in_world = inWorld(pose);
    forget(in_world.uncertainty, [&](std::int32_t cluster) {
        return std::find(clusters.begin(), clusters.end(), cluster) == clusters.end();
    });
    forgetAll(in_world_.back());
    return add(timestamp, in_world.T_keyframe_camera, pose, std::move(in_world.uncertainty));
}

int Trajectory::add(double timestamp, const Pose& T_world_camera, const RelativePose& link,
                    PoseUncertainty in_world) {
    const int id = static_cast<int>(keyframes_.size());
    // All three lists get longer or, where memory runs out, none
    makeRoom(keyframes_), makeRoom(in_world_), makeRoom(links_);
    const int track = link.keyframe < 0 ? id : beginOfTrack(link.keyframe);
    keyframes_.push_back({id, timestamp, T_world_camera, track});
    in_world_.push_back(std::move(in_world));
    links_.push_back(link);
    return id;
}

void Trajectory::findTracks() {
    for (std::size_t id = 0; id < links_.size(); ++id)
        keyframes_[id].track =
            links_[id].keyframe < 0 ? static_cast<int>(id) : beginOfTrack(links_[id].keyframe);
}

std::vector<int> Trajectory::tracks() const {
    std::vector<int> tracks;
    for (const KeyframeInfo& keyframe : keyframes_) tracks.push_back(keyframe.track);
    return tracks;
}

void Trajectory::addFrame(double timestamp, const RelativePose& pose, bool measured) {
    frames_.push_back({timestamp, pose, measured});
    live_.push_back({timestamp, worldPose(pose)});
    for (; timestamp - frames_[recent_].timestamp > kRecent; ++recent_)
        forgetAll(frames_[recent_].pose.uncertainty);
}

void Trajectory::measureAfterwards(double timestamp, const RelativePose& pose) {
    const auto frame = std::lower_bound(frames_.begin(), frames_.end(), timestamp,
                                        [](const Frame& f, double t) { return f.timestamp < t; });
    if (frame == frames_.end() || frame->timestamp != timestamp)
        throw std::logic_error("a frame that was not added has no pose to be measured");
    *frame = {timestamp, pose, true};
    if (frame - frames_.begin() < static_cast<std::ptrdiff_t>(recent_)) forgetAll(frame->pose.uncertainty);
}

const Trajectory::Frame& Trajectory::frame(std::size_t index) const {
    if (index < frames_.size()) return frames_[index];
    throw std::out_of_range("there is no frame " + std::to_string(static_cast<std::ptrdiff_t>(index)) + ": " +
                            std::to_string(frames_.size()) +
                            " frames have a pose, and their indices begin with 0 (-1: a rejected one)");
}

RelativePose Trajectory::inWorld(const RelativePose& pose) const {
    return compose({-1, keyframePose(pose.keyframe), at(in_world_, pose.keyframe)}, pose);
}

Pose Trajectory::worldPose(const RelativePose& pose) const {
    return keyframePose(pose.keyframe) * pose.T_keyframe_camera;
}

Matrix6d Trajectory::worldCovariance(const RelativePose& pose) const {
    const RelativePose in_world = inWorld(pose);
    const Matrix6d to_world = turnedBy(in_world.T_keyframe_camera.linear());
    return to_world * in_world.covariance() * to_world.transpose();
}

Matrix6d Trajectory::motionCovariance(std::size_t from, std::size_t to) const {
    RelativePose first = frame(from).pose, last = frame(to).pose;
    while (first.keyframe != last.keyframe) {  // back to the newest keyframe that both come from
        RelativePose& later = first.keyframe > last.keyframe ? first : last;
        const RelativePose& link = at(links_, later.keyframe);
        if (link.keyframe < 0) return Matrix6d::Constant(std::numeric_limits<double>::infinity());
        later = compose(link, later);
    }
    const Matrix6d by_motions = changeReference(last, first, -1).covariance();
    // What is known of both in the world may tell more, where a place was seen again
    const Matrix6d by_places =
        changeReference(inWorld(frames_[to].pose), inWorld(frames_[from].pose), -1).covariance();
    return by_places.trace() < by_motions.trace() ? by_places : by_motions;
}

Correction Trajectory::join(int keyframe, const RelativePose& pose) {
    const int begin = beginOfTrack(keyframe);
    if (beginOfTrack(pose.keyframe) > begin)
        return join(pose.keyframe, changeReference({pose.keyframe, Pose(), {}}, pose, keyframe));
    Correction join;
    join.places.push_back({pose.keyframe, keyframe, pose.T_keyframe_camera, pose.covariance()});
    const Pose motion = worldPose(pose) * keyframePose(keyframe).inverse();
    for (int id = begin; id < static_cast<int>(keyframes_.size()); ++id) {
        if (beginOfTrack(id) != begin) continue;
        Pose& placed = at(keyframes_, id).T_world_camera;
        placed = motion * placed;
        join.motions.emplace(id, motion);
    }
    // As well known as what was recognised, seen from there. A track is linked to what is older than all of
    // it
    RelativePose link = pose;
    while (link.keyframe > begin) link = compose(at(links_, link.keyframe), link);
    at(links_, begin) = {link.keyframe,
                         keyframePose(link.keyframe).inverse() * keyframePose(begin),
                         {carried(link.covariance(), keyframe, begin), {}}};
    // The recognised one is as well known as that, the others less by what they drifted from it
    const Matrix6d recognised = inWorld(pose).covariance();
    std::vector<std::pair<int, Matrix6d>> known;
    for (const auto& [id, by] : join.motions) {
        const int newer = std::max(id, keyframe);
        const Matrix6d drifted = positivePart(drift(std::min(id, keyframe), newer));
        known.emplace_back(id, carried(recognised, keyframe, id) + carried(drifted, newer, id));
    }
    for (auto& [id, covariance] : known) at(in_world_, id) = {covariance, {}};
    findTracks();
    corrections_.push_back(join);
    return join;
}

std::vector<PoseConstraint> Trajectory::constraintsOf(int track) const {
    std::vector<PoseConstraint> constraints;
    // As the map has it, and as well known as tracking knows it: the map's own knowledge is in its edges
    const auto relate = [&](int from, int to, const Matrix6d& covariance) {
        if (beginOfTrack(from) != track || beginOfTrack(to) != track) return;
        constraints.push_back({from, to, keyframePose(from).inverse() * keyframePose(to), covariance});
    };
    for (std::size_t id = 0; id < links_.size(); ++id)
        if (links_[id].keyframe >= 0)
            relate(links_[id].keyframe, static_cast<int>(id), links_[id].covariance());
    for (const auto& [older, newer] : related_) {
        const RelativePose& link = at(links_, newer);
        if (link.keyframe >= 0) relate(older, newer, link.covariance());
    }
    return constraints;
}

Correction Trajectory::closeLoop(const std::vector<std::pair<int, RelativePose>>& recognised) {
    const int track = beginOfTrack(recognised.front().first);
    std::vector<PoseConstraint> constraints = constraintsOf(track), loops = loops_;
    Correction correction;
    for (const auto& [keyframe, pose] : recognised)
        correction.places.push_back({pose.keyframe, keyframe, pose.T_keyframe_camera, pose.covariance()});
    loops.insert(loops.end(), correction.places.begin(), correction.places.end());
    for (const PoseConstraint& loop : loops)
        if (beginOfTrack(loop.to) == track) constraints.push_back(loop);
    std::vector<Pose> poses;
    for (const KeyframeInfo& keyframe : keyframes_) poses.push_back(keyframe.T_world_camera);
    if (!optimisePoseGraph(poses, constraints, std::max(track, held_ - 1))) return {};
    // Tracking may have drifted by more than it knows, but places cannot contradict each other
    for (const PoseConstraint& loop : loops)
        if (beginOfTrack(loop.to) == track && contradiction(poses, loop) > kMostContradiction) return {};
    for (std::size_t id = 0; id < poses.size(); ++id) {
        if (keyframes_[id].track != track || static_cast<int>(id) < held_) continue;
        Pose& placed = keyframes_[id].T_world_camera;
        correction.motions.emplace(static_cast<int>(id), poses[id] * placed.inverse());
        placed = poses[id];
    }
    loops_ = std::move(loops);
    corrections_.push_back(correction);
    const auto& [keyframe, pose] = recognised.back();
    const PoseUncertainty by_loop{inWorld(pose).covariance(), {}};
    PoseUncertainty& known = at(in_world_, keyframe);
    if (by_loop.independent.trace() < known.covariance().trace()) known = by_loop;
    return correction;
}

void Trajectory::apply(const MapUpdate& update) {
    // Updates come in order: those of keyframes from before a correction know nothing of it
    eraseIf(corrections_, [&](const Correction& c) { return c.motions.rbegin()->first < update.keyframe; });
    for (const auto& [id, pose] : update.poses) {
        Pose& placed = at(keyframes_, id).T_world_camera;
        placed = pose;
        for (const Correction& correction : corrections_)
            if (const auto found = correction.motions.find(id); found != correction.motions.end())
                placed = found->second * placed;
    }
    for (auto id = static_cast<std::size_t>(update.keyframe) + 1; id < keyframes_.size(); ++id) {
        if (links_[id].keyframe < 0) continue;
        keyframes_[id].T_world_camera = keyframePose(links_[id].keyframe) * links_[id].T_keyframe_camera;
    }
    if (update.posterior) takePosterior(*update.posterior, update.keyframe);
}

/// A keyframe's covariance as it errs with an older one's.
Matrix6d Trajectory::carried(const Matrix6d& covariance, int from, int to) const {
    const Matrix6d by = carriedTo(keyframePose(from).inverse() * keyframePose(to));
    return by * covariance * by.transpose();
}

Matrix6d Trajectory::drift(int older, int keyframe) const {
    const auto known = [&](int id) { return at(in_world_, id).covariance(); };
    return known(keyframe) - carried(known(older), older, keyframe);
}

/// Where older keyframes are seen again, a new one errs no more than they do, but for what pulls it to the
/// oldest one of the window.
void Trajectory::takePosterior(const WindowPosterior& posterior, int keyframe) {
    const Matrix6d drifted = positivePart(drift(posterior.reused, posterior.oldest));
    PoseUncertainty seen_again = posterior.uncertainty;
    seen_again.independent +=
        carried(at(in_world_, posterior.reused).covariance(), posterior.reused, keyframe) +
        posterior.follows * drifted * posterior.follows.transpose();
    const auto seen = static_cast<std::size_t>(keyframe);
    PoseUncertainty& known = in_world_[seen];
    if (seen_again.covariance().trace() >= known.covariance().trace()) return;
    known = std::move(seen_again);
    for (std::size_t id = seen + 1; id < links_.size(); ++id)
        if (links_[id].keyframe >= keyframe) in_world_[id] = inWorld(links_[id]).uncertainty;
    for (std::size_t id = seen; id + 1 < in_world_.size(); ++id) forgetAll(in_world_[id]);
}

}  // namespace roevo
