// Poses of all frames, as they are known in the end.
#include <algorithm>
#include <map>

#include "motion_smoother.h"
#include "tracking/se3.h"
#include "trajectory.h"

namespace roevo {
namespace {

constexpr double kTypicalDepth = 2;  // m; at this depth a turn by 1 rad changes a view like so many metres
constexpr double kSameView = 0.02;   // m; less change of view than this is hardly any

double changeOfView(const Pose& motion) {
    return motion.translation().norm() + kTypicalDepth * rotationAngle(motion);
}

}  // namespace

Pose Trajectory::finalPose(const Frame& frame) const {
    const RelativePose& link = frame.pose;
    const Pose from_parent = worldPose(link);
    const auto next = static_cast<std::size_t>(link.keyframe) + 1;
    if (next >= links_.size() || links_[next].keyframe != link.keyframe) return from_parent;
    // Else it was tracked backwards, or long after
    const double begin = keyframes_[next - 1].timestamp, end = keyframes_[next].timestamp;
    if (frame.timestamp < begin || frame.timestamp > end) return from_parent;
    const Pose T_next_camera = links_[next].T_keyframe_camera.inverse() * link.T_keyframe_camera;
    const Pose from_next = keyframes_[next].T_world_camera * T_next_camera;
    // Where the camera hardly moves, changes are noise of tracking, and time shares better
    const double passed = end > begin ? std::clamp((frame.timestamp - begin) / (end - begin), 0.0, 1.0) : 1;
    const double since = changeOfView(link.T_keyframe_camera) + kSameView * passed;
    const double left = changeOfView(T_next_camera) + kSameView * (1 - passed);
    return interpolate(from_parent, from_next, since / (since + left));
}

/// Whether it became one, itself or when the next frame had come.
bool Trajectory::isKeyframe(const Frame& frame) const {
    const auto next = static_cast<std::size_t>(frame.pose.keyframe) + 1;
    return keyframes_[next - 1].timestamp == frame.timestamp ||
           (next < keyframes_.size() && keyframes_[next].timestamp == frame.timestamp);
}

bool Trajectory::isMeasured(std::size_t frame, int track) const {
    return frames_[frame].measured && beginOfTrack(frames_[frame].pose.keyframe) == track;
}

/// So many frames of each track; of those that have none, nothing.
std::map<int, std::ptrdiff_t> Trajectory::measuredOfTracks() const {
    std::map<int, std::ptrdiff_t> measured;
    for (const Frame& frame : frames_)
        if (frame.measured) ++measured[beginOfTrack(frame.pose.keyframe)];
    return measured;
}

/// Smooths or bridges poses, from the first to the last frame of a track that was measured.
void Trajectory::bridge(int track, const std::vector<std::size_t>& indices, bool smooth,
                        std::vector<StampedPose>& poses) const {
    const auto measured = [&](std::size_t k) { return isMeasured(k, track); };
    const auto begin = std::find_if(indices.begin(), indices.end(), measured);
    const auto end = std::find_if(indices.rbegin(), indices.rend(), measured).base();
    std::vector<MotionSample> samples;
    for (auto k = begin; k < end; ++k) {
        const Frame& frame = frames_[*k];
        // A keyframe is where the map has it
        const Matrix6d covariance = isKeyframe(frame) ? Matrix6d::Zero() : frame.pose.uncertainty.own();
        samples.push_back({frame.timestamp, poses[*k].T_world_camera, covariance, measured(*k)});
    }
    (smooth ? smoothMotion : bridgeMotion)(samples);
    for (std::size_t k = 0; k < samples.size(); ++k)
        poses[*(begin + static_cast<std::ptrdiff_t>(k))].T_world_camera = samples[k].T_world_camera;
}

/// Where other tracks were begun was a guess. Those that lie whole between two frames of this one are put
/// there, and a moment right before or after it beside its end.
/// @param bridged  poses as if only this track had measured any
void Trajectory::fitOthers(int track, const std::vector<StampedPose>& bridged,
                           std::vector<StampedPose>& poses) const {
    const std::map<int, std::ptrdiff_t> measured = measuredOfTracks();
    std::vector<std::size_t> known, others;
    for (std::size_t k = 0; k < frames_.size(); ++k)
        if (isMeasured(k, track)) known.push_back(k);
    for (std::size_t i = 0; i <= known.size(); ++i) {  // the gap before the i-th that is known
        const bool has_before = i > 0, has_after = i < known.size();
        const std::size_t begin = has_before ? known[i - 1] + 1 : 0,
                          end = has_after ? known[i] : frames_.size();
        others.clear();
        std::map<int, std::ptrdiff_t> here;
        for (std::size_t k = begin; k < end; ++k) {
            if (!frames_[k].measured) continue;
            others.push_back(k);
            ++here[beginOfTrack(frames_[k].pose.keyframe)];
        }
        const bool some_elsewhere = std::any_of(here.begin(), here.end(), [&](const auto& counted) {
            return counted.second < measured.at(counted.first);
        });
        if (others.empty() || some_elsewhere) continue;
        const std::size_t first = others.front(), last = others.back();
        const auto moved = [&](const StampedPose& to, std::size_t from) {
            return to.T_world_camera * poses[from].T_world_camera.inverse();
        };
        if (has_before && has_after) {
            // In a short gap another track saw what hid the scene; a long one knows how the camera moved
            const bool is_short = poses[end].timestamp - poses[begin - 1].timestamp <= kLongestGap;
            const Pose at_first = moved(bridged[first], first), at_last = moved(bridged[last], last);
            const double begun = poses[first].timestamp, span = poses[last].timestamp - begun;
            for (std::size_t k = begin; k < end; ++k) {
                Pose& pose = poses[k].T_world_camera;
                const bool bent = !is_short && k >= first && k <= last;
                const double share = span > 0 ? (poses[k].timestamp - begun) / span : 0;
                pose = bent ? interpolate(at_first * pose, at_last * pose, share) : bridged[k].T_world_camera;
            }
        } else if ((has_after ? last + 1 == end : first == begin) &&
                   poses[last].timestamp - poses[first].timestamp <= kLongestGap) {
            const Pose beside = has_after ? moved(poses[end], last) : moved(poses[begin - 1], first);
            for (std::size_t k = begin; k < end; ++k)
                poses[k].T_world_camera = beside * poses[k].T_world_camera;
        }
    }
}

std::vector<StampedPose> Trajectory::frames(bool smooth) const {
    std::vector<StampedPose> poses;
    for (const Frame& frame : frames_) poses.push_back({frame.timestamp, finalPose(frame)});
    const std::map<int, std::ptrdiff_t> measured = measuredOfTracks();
    if (measured.empty()) return poses;
    std::map<int, std::vector<std::size_t>> of_tracks;
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
        of_tracks[beginOfTrack(frames_[k].pose.keyframe)].push_back(k);
        all.push_back(k);
    }
    // The world is that of a map that was loaded, else the longest track's
    int track = 0;
    if (loaded_ == 0 || measured.count(0) == 0)
        track = std::max_element(measured.begin(), measured.end(), [](const auto& a, const auto& b) {
                    return a.second < b.second;
                })->first;
    std::vector<StampedPose> bridged = poses;
    bridge(track, all, smooth, bridged);
    for (const auto& [other, indices] : of_tracks) {
        if (other != track)
            bridge(other, indices, smooth, poses);
        else
            for (const std::size_t k : indices) poses[k] = bridged[k];
    }
    fitOthers(track, bridged, poses);
    return poses;
}

}  // namespace roevo
