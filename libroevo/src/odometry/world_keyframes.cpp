// How frames become keyframes, and keyframes the reference.
#include <algorithm>

#include "tracking/se3.h"
#include "world.h"

namespace roevo {
namespace {

constexpr int kStillInView = 10;       // newest keyframes
constexpr double kLeastOfShown = 0.5;  // points of a new keyframe, against what the old one still shows there
constexpr std::size_t kMostFormer = 30;  // references that can be returned to: about a megabyte each

}  // namespace

/// @param needed  points, at least. @return null, and why, where it cannot be a keyframe
std::unique_ptr<Keyframe> World::make(const Frame& frame, const RowMotion& rows, int needed,
                                      Fault& fault) const {
    auto fresh = std::make_unique<Keyframe>();
    fault = makeKeyframe(frame, rows, needed, camera_, options_, tracker_, *fresh);
    return fault ? nullptr : std::move(fresh);
}

std::unique_ptr<Keyframe> World::outside(const Frame& frame, const RowMotion& rows) const {
    Fault ignored;
    auto fresh = make(frame, rows, options_.fine.min_inliers, ignored);
    std::int32_t next = 0;
    if (fresh) numberEdges(*fresh, nullptr, {}, next);
    return fresh;
}

Fault World::addKeyframe(const Frame& frame, const Tracking& tracked) {
    // Where depth drops out, the reference is worth more than the scrap that would take its place. There is
    // none where the first frame was recognised in a map
    const double still_shown =
        reference_ ? tracked.matches.shownShare() * static_cast<double>(reference_->edges.size()) : 0;
    const int needed = std::max(options_.fine.min_inliers, static_cast<int>(kLeastOfShown * still_shown));
    Fault fault;
    auto fresh = make(frame, tracked.rows, needed, fault);
    if (!fresh) return fault;
    numberEdges(*fresh, reference_.get(), tracked.matches, next_cluster_);
    recognise();
    fresh->id = trajectory_.addKeyframe(frame.timestamp(), tracked.pose, fresh->clusters);
    adopt(std::move(fresh), frame, tracked.pose);
    return {};
}

void World::adopt(std::unique_ptr<Keyframe> fresh, const Frame& of, const RelativePose& tracked) {
    std::vector<Rgb> colours = coloursOf(fresh->edges.image, of.images, camera_);
    if (remembersPlaces()) {
        relocaliser_.add(*fresh, of, colours, trajectory_.tracks(),
                         closesLoops() ? fresh->id - kStillInView : 0);
        recognised_at_ = timestamp_ + (options_.mapping.latency - 0.5) / kFrameRate;
        waitForNextLook();
    }
    semi_dense_.add(fresh->edges.image, of.images, fresh->row_motion);
    mapper_->insert({*fresh, std::move(colours), trajectory_.keyframePose(fresh->id), tracked,
                     reference_.get(), seconds_per_row_},
                    timestamp_);
    makeReference(std::move(fresh));
    noteTrack();
}

void World::makeReference(std::unique_ptr<Keyframe> keyframe) {
    if (reference_) former_.push_back(std::move(reference_));
    if (former_.size() > (options_.mode == Mode::kTracking ? kMostFormer : 1)) former_.erase(former_.begin());
    reference_ = std::move(keyframe);
}

/// With its points where they are by what is known of the rows now.
const Keyframe* World::upToDate(Keyframe& keyframe) const {
    keyframe.setRowMotion(keyframe.row_motion.at(seconds_per_row_));
    return &keyframe;
}

const Keyframe* World::previous(Pose& T_previous_reference) {
    if (former_.empty() || !trajectory_.areOfOneTrack(former_.back()->id, reference_->id)) return nullptr;
    T_previous_reference =
        trajectory_.keyframePose(former_.back()->id).inverse() * trajectory_.keyframePose(reference_->id);
    return upToDate(*former_.back());
}

const Keyframe* World::nearest(const RelativePose& pose, Pose& T_nearest_camera) {
    if (options_.mode != Mode::kTracking) return nullptr;  // docs/choices.md, Keyframes
    Keyframe* found = nullptr;
    double least = 1;
    for (const auto& keyframe : former_) {
        if (!trajectory_.areOfOneTrack(keyframe->id, reference_->id)) continue;
        const Pose T = trajectory_.keyframePose(keyframe->id).inverse() * trajectory_.worldPose(pose);
        const double change = changeOfView(keyframe->median_depth, T, options_.keyframe);
        if (change >= least) continue;
        least = change;
        found = keyframe.get();
        T_nearest_camera = T;
    }
    return found != nullptr ? upToDate(*found) : nullptr;
}

void World::returnTo(const RelativePose& before, const RelativePose& now) {
    recognise();  // the newest keyframe's place, while that is the reference
    noteMotion(trajectory_.worldPose(before), trajectory_.worldPose(now));
    const auto found = std::find_if(former_.begin(), former_.end(),
                                    [&](const auto& keyframe) { return keyframe->id == now.keyframe; });
    auto keyframe = std::move(*found);
    former_.erase(found);
    makeReference(std::move(keyframe));
}

}  // namespace roevo
