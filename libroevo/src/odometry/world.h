#pragma once
#include <map>
#include <optional>
#include <utility>

#include "keyframe_maker.h"
#include "mapping/mapper.h"
#include "mapping/semi_dense.h"
#include "relocaliser.h"
#include "stored_map.h"
#include "trajectory.h"

namespace roevo {

/// Where the camera has been: the keyframe that is tracked against, and with all that were, the trajectory,
/// the map and what their places look like. It alone puts the world together; tracking knows one keyframe.
class World {
  public:
    /// @param camera   with its lens
    /// @param options  as given
    /// @param tracker  chooses points of keyframes
    World(const PinholeCamera& camera, const OdometryOptions& options, const Tracker& tracker);

    /// Begins with a map, before anything else.
    /// @param held  it stays as it is: nothing moves its keyframes
    /// @return seconds per row, as its newest keyframe knows them; nothing where none does
    /// @throws std::runtime_error, in one line, where it cannot be used
    std::optional<double> load(StoredMap map, bool held);
    /// All keyframes that hang together, in a map: those that were loaded, else most of them.
    /// @throws std::runtime_error where places are not remembered; std::logic_error where a map is held
    StoredMap map();
    /// Keyframes that were loaded: the first ones.
    int loaded() const { return loaded_; }

    bool empty() const { return !reference_; }
    Keyframe& reference() { return *reference_; }
    const Trajectory& trajectory() const { return trajectory_; }
    /// As FrameResult::covariance.
    Matrix6d covariance(const RelativePose& pose) const;
    /// As Odometry::motionCovariance().
    Matrix6d motionCovariance(std::size_t from, std::size_t to) const;
    void addFrame(double timestamp, const RelativePose& pose, bool measured) {
        trajectory_.addFrame(timestamp, pose, measured);
    }
    void measureAfterwards(double timestamp, const RelativePose& pose) {
        trajectory_.measureAfterwards(timestamp, pose);
    }

    /// Brings everything to the time of a frame: map updates and recognised places that are due take effect.
    /// @param seconds_per_row  read-out time as known by now
    void advance(double timestamp, double seconds_per_row);
    /// What became of the keyframes since this was asked last, as the next frame's result has it.
    FrameResult changes() { return std::exchange(change_, {}); }

    /// A frame as a keyframe of its own, which stays outside of the world. Null where it cannot be one.
    [[nodiscard]] std::unique_ptr<Keyframe> outside(const Frame& frame, const RowMotion& rows) const;
    /// A frame becomes the reference: the first, or one after a loss.
    /// @param lost_for  s, since the camera's pose was known: so far may it have come
    Fault beginTrack(const Frame& frame, const RowMotion& rows, const Pose& T_world_camera,
                     const Matrix6d& covariance, double lost_for);
    /// A frame that was tracked, or recognised, becomes the reference.
    Fault addKeyframe(const Frame& frame, const Tracking& tracked);

    /// The keyframe that a lost frame shows, and its pose relative to that.
    /// @param last            where it was last; of no keyframe where that is not known
    /// @param since_measured  s, since the camera's pose was known
    [[nodiscard]] std::optional<RelativePose> find(const Frame& frame, const RelativePose& last,
                                                   double since_measured);
    /// Now and then, ever less often: whether a frame that was tracked shows a place of a track that this one
    /// is not joined to yet, for sure.
    [[nodiscard]] bool lookForOtherTrack(const Frame& frame, const RelativePose& pose);
    /// The reference before this one, of the same track, and where this one is from there. Null where there
    /// is none.
    [[nodiscard]] const Keyframe* previous(Pose& T_previous_reference);
    /// Of the keyframes before the reference, that from which a camera is seen least differently by the
    /// keyframe policy's measures, and where the camera is from there. Null where none is near, and in other
    /// modes than tr.
    [[nodiscard]] const Keyframe* nearest(const RelativePose& pose, Pose& T_nearest_camera);
    /// That one becomes the reference again.
    /// @param before, now  pose of the frame against the reference, and against that one
    void returnTo(const RelativePose& before, const RelativePose& now);
    /// The pose against a keyframe that edges agree on with nothing known of the motion, if they do.
    [[nodiscard]] std::optional<RelativePose> confirm(const Keyframe& keyframe, const Frame& frame,
                                                      const Pose& T_keyframe_camera, const RowMotion& rows) {
        return relocaliser_.confirm(keyframe, frame, T_keyframe_camera, rows);
    }
    /// See Odometry::refineAll().
    std::vector<MapRefusal> refineAll();

    /// With what has not taken effect yet.
    Trajectory finalTrajectory() const;
    /// The camera was recognised in the map that was loaded. Before that, the map is in a world of its own.
    bool isLocalised() const { return localised_; }
    std::vector<KeyframeInfo> keyframes() const;
    EdgeMap fusedMap() const { return inThisWorld(mapper_->fusedMap()); }
    EdgeMap keyframeEdges() const { return inThisWorld(mapper_->keyframeEdges()); }
    std::vector<ColouredPoint> semiDense() {
        return semi_dense_.inWorld(finalTrajectory().keyframes(), static_cast<std::size_t>(unrelated()));
    }

  private:
    std::unique_ptr<Keyframe> make(const Frame& frame, const RowMotion& rows, int needed, Fault& fault) const;
    void waitForNextLook();
    void makeReference(std::unique_ptr<Keyframe> keyframe);
    const Keyframe* upToDate(Keyframe& keyframe) const;
    void adopt(std::unique_ptr<Keyframe> fresh, const Frame& of, const RelativePose& tracked);
    void recognise();
    struct Look {
        int keyframe = -1;
        RecognisedPlace place;
    };
    std::optional<Look> agreeing(std::optional<Look>& look, const Look& newest, double tolerance) const;
    /// How far a keyframe's track may be from where it was put, at the keyframe.
    Reach misplacementOf(int keyframe) const;
    /// How far a keyframe may have drifted from the first one of its track.
    Reach driftOf(int keyframe) const;
    /// @param lost_for  s, since the pose was known; of no keyframe where nothing is
    Whereabouts whereabouts(const RelativePose& pose, double lost_for) const;
    bool joinElsewhere(const Whereabouts& near);
    void join(const Look& look);
    void closeLoop(const Look& newest);
    bool isWithinReach(const RelativePose& pose) const;
    void takeUpdate(const MapUpdate& update);
    void noteMotion(const Pose& before, const Pose& after);
    void noteTrack();
    bool closesLoops() const;
    bool remembersPlaces() const;
    /// Keyframes before this one are in another world.
    int unrelated() const { return localised_ ? 0 : loaded_; }
    EdgeMap inThisWorld(EdgeMap edges) const;

    PinholeCamera camera_;
    OdometryOptions options_;  // scaled to the camera
    const Tracker& tracker_;
    std::unique_ptr<Mapper> mapper_;
    Relocaliser relocaliser_;
    SemiDenseStore semi_dense_;
    Trajectory trajectory_;
    std::unique_ptr<Keyframe> reference_;
    std::vector<std::unique_ptr<Keyframe>> former_;  // that were the reference, the last one last
    std::int32_t next_cluster_ = 0;
    int loaded_ = 0;
    bool held_ = false;
    bool localised_ = false;  // in the map that was loaded
    double timestamp_ = 0, seconds_per_row_ = 0;
    std::map<int, Reach> misplacements_;         // of tracks that were begun after a loss
    double track_begun_at_ = 0;                  // s
    double next_look_ = 0;                       // s; not before are frames looked up among other tracks
    std::optional<double> recognised_at_;        // s; the place of the newest keyframe is to be known by then
    std::optional<Look> join_look_, loop_look_;  // that a second one must agree with
    FrameResult change_;
};

}  // namespace roevo
