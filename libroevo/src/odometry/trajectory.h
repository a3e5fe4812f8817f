#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "mapping/local_mapper.h"
#include "mapping/pose_graph.h"
#include "roevo/frame_result.h"
#include "tracking/relative_pose.h"

namespace roevo {

/// All that is known of keyframes and not of frames, by their ids.
struct KeyframeGraph {
    std::vector<KeyframeInfo> keyframes;
    std::vector<RelativePose> links;    ///< to the ones before; -1: to the world
    std::vector<Matrix6d> covariances;  ///< in the world, along the cameras' axes
    std::vector<std::pair<int, int>> related;
    std::vector<PoseConstraint> loops;
};

/// The only one that knows the world: poses of keyframes, and of frames relative to them. When the map moves
/// a keyframe, all frames that were tracked against it follow.
class Trajectory {
  public:
    /// Begins with keyframes of an earlier recording, in one track.
    /// @param held  nothing moves them any more
    void load(KeyframeGraph graph, bool held);
    KeyframeGraph graph() const;

    /// A keyframe that was tracked from none: the first, or re-anchored. @return its id
    int beginTrack(double timestamp, const Pose& T_world_camera, const Matrix6d& covariance);
    /// @param pose  relative to the keyframe that it was tracked from. @return its id
    /// @param clusters  of its edges; what other edges did to its pose is from now on independent
    int addKeyframe(double timestamp, const RelativePose& pose, const std::vector<std::int32_t>& clusters);
    /// @param measured  else its final pose is bridged between measured ones, where there are any
    void addFrame(double timestamp, const RelativePose& pose, bool measured = true);
    /// The pose of a frame that was added without a measured one, now that there is one.
    void measureAfterwards(double timestamp, const RelativePose& pose);

    /// First keyframe of a keyframe's track.
    int beginOfTrack(int keyframe) const { return at(keyframes_, keyframe).track; }
    bool areOfOneTrack(int keyframe, int other) const {
        return beginOfTrack(keyframe) == beginOfTrack(other);
    }
    /// The same of each keyframe.
    std::vector<int> tracks() const;
    /// Moves a keyframe's track to where the keyframe was recognised; where that is in a younger track, moves
    /// that one.
    /// @param pose  of the keyframe, relative to one of another track
    Correction join(int keyframe, const RelativePose& pose);
    /// Two keyframes, the older one first, show the same place, and are where that is: no loop moves them
    /// apart. A pair counts once.
    void relate(int older, int newer) {
        const std::pair<int, int> pair(older, newer);
        if (std::find(related_.rbegin(), related_.rend(), pair) == related_.rend()) related_.push_back(pair);
    }
    /// Moves the keyframes of a track, all a little, so that those that were recognised are where they were
    /// seen: a pose graph of tracked motions, of what is related, and of all loops so far.
    /// @param recognised  keyframes and their poses relative to older ones of the same track
    /// @return moves nothing where loops contradict each other
    Correction closeLoop(const std::vector<std::pair<int, RelativePose>>& recognised);

    /// Moves the keyframes as the map has it; younger ones follow the one that they were tracked from.
    void apply(const MapUpdate& update);

    Pose worldPose(const RelativePose& pose) const;
    /// Of the last frame, with all corrections since; identity where there is none.
    Pose lastPose() const { return frames_.empty() ? Pose() : worldPose(frames_.back().pose); }
    /// As FrameResult::covariance.
    Matrix6d worldCovariance(const RelativePose& pose) const;
    /// What a keyframe's covariance has beyond that of an older one, along its own axes.
    Matrix6d drift(int older, int keyframe) const;
    /// Of the motion from one frame to another (their indices in the order of addFrame()): of T_from_to,
    /// position, then orientation, along the axes of the second camera. Not finite where they are in
    /// different tracks.
    Matrix6d motionCovariance(std::size_t from, std::size_t to) const;

    /// T_from_to of these frames.
    Pose motion(std::size_t from, std::size_t to) const {
        return worldPose(frame(from).pose).inverse() * worldPose(frame(to).pose);
    }

    const std::vector<KeyframeInfo>& keyframes() const { return keyframes_; }
    const Pose& keyframePose(int id) const { return at(keyframes_, id).T_world_camera; }
    /// Poses of the frames. What the map found to be wrong with the tracked motion to the next keyframe was
    /// wrong with the motions of the frames between in part: tracking errs the more the view differs from the
    /// keyframe's. Where they were not measured, they are between those that were; so are tracks that were
    /// never joined (fitOthers()).
    /// @param smooth  see smoothMotion()
    std::vector<StampedPose> frames(bool smooth = true) const;
    /// As they were known when they were added.
    const std::vector<StampedPose>& live() const { return live_; }

  private:
    struct Frame {
        double timestamp = 0;
        RelativePose pose;
        bool measured = true;
    };
    /// @throws std::out_of_range
    const Frame& frame(std::size_t index) const;
    /// @param link  to the one before
    int add(double timestamp, const Pose& T_world_camera, const RelativePose& link, PoseUncertainty in_world);
    void findTracks();
    RelativePose inWorld(const RelativePose& pose) const;
    Matrix6d carried(const Matrix6d& covariance, int from, int to) const;
    void takePosterior(const WindowPosterior& posterior, int keyframe);
    Pose finalPose(const Frame& frame) const;
    bool isKeyframe(const Frame& frame) const;
    bool isMeasured(std::size_t frame, int track) const;
    std::map<int, std::ptrdiff_t> measuredOfTracks() const;
    void bridge(int track, const std::vector<std::size_t>& indices, bool smooth,
                std::vector<StampedPose>& poses) const;
    void fitOthers(int track, const std::vector<StampedPose>& bridged, std::vector<StampedPose>& poses) const;
    std::vector<PoseConstraint> constraintsOf(int track) const;

    int loaded_ = 0, held_ = 0;  ///< so many keyframes were loaded; do not move
    std::vector<KeyframeInfo> keyframes_;
    std::vector<Correction> corrections_;       ///< that updates to come do not know of yet
    std::vector<std::pair<int, int>> related_;  ///< see relate()
    std::vector<PoseConstraint> loops_;
    std::vector<PoseUncertainty> in_world_;  ///< of the keyframes; influences of the newest alone
    std::vector<RelativePose> links_;        ///< of the keyframes, to the ones before; -1: to the world
    std::vector<Frame> frames_;
    std::size_t recent_ = 0;  ///< the oldest frame that nothing was forgotten of
    std::vector<StampedPose> live_;
};

}  // namespace roevo
