#pragma once
#include <exception>
#include <functional>
#include <future>
#include <optional>
#include <vector>

#include "mapping/packed_keyframe.h"
#include "place/place_describer.h"
#include "place/place_evidence.h"
#include "place/place_index.h"
#include "tracking/relative_pose.h"
#include "trajectory.h"

namespace roevo {

/// How far a pose may be off at most. Infinite where that is not known at all.
struct Reach {
    double distance = 0, turn = 0;  ///< m, rad
};

/// Where a camera can be at most.
struct Whereabouts {
    Pose T_world_camera;  ///< where it is thought to be
    /// How far from there, relative to a keyframe.
    std::function<Reach(int keyframe)> reach;
    double unseen = 0;  ///< m; of it, how far it can have come while nothing was tracked

    bool allow(const Pose& T_world_there, int keyframe) const;
};

/// What a keyframe is recognised by.
struct KnownPlace {
    PlacePoints points;
    PackedKeyframe edges;
    double median_depth = 0;  ///< m
    RowMotion row_motion;
};

/// Keyframes, as seen from the newest one.
enum class Among { kOwnTrack, kOtherTracks, kAllTracks };

/// @param tracks  of all keyframes, as Trajectory::tracks(). @return whether some are not of the newest one's
bool hasOtherTracks(const std::vector<int>& tracks);

/// A place that a frame may show, as far as one look tells.
struct RecognisedPlace {
    RelativePose pose;
    Evidence evidence = Evidence::kNone;
    double likeness = 0;  ///< share of the place's points in view that look as they did
    double matched = 0;   ///< share of the edges, of the smaller of both ways
    bool sure = false;    ///< else a second look must agree
};

/// Remembers what keyframes look like, and finds which of them a frame shows. Places that look alike are not
/// taken for each other: either points and edges tell the place from all others, or no other within reach of
/// the camera looks like it.
class Relocaliser {
  public:
    /// @param camera   with its lens
    /// @param options  as given: scaled to the camera here
    Relocaliser(const PinholeCamera& camera, const OdometryOptions& options);

    Relocaliser(const Relocaliser&) = delete;  // the thread points to it
    Relocaliser& operator=(const Relocaliser&) = delete;

    /// Begins with the places of these keyframes.
    void load(std::vector<KnownPlace> places);
    /// Of all keyframes, by their ids; waits for the thread.
    const std::vector<KnownPlace>& places();

    /// In a thread of its own, or when it is asked for where there is but one.
    /// @param frame    that the keyframe was made of
    /// @param colours  of the keyframe's points
    /// @param tracks   of all keyframes. Those of its own track are looked for apart from the others: they
    ///                 look more like the new one.
    /// @param end      only keyframes of its own track before this one are looked for
    void add(const Keyframe& keyframe, const Frame& frame, std::vector<Rgb> colours, std::vector<int> tracks,
             int end);

    /// Older keyframes of its own track that the newest one looks like, and its poses relative to them by
    /// points alone: about right, with no covariance. Waits for the thread.
    /// @param whereabouts  of the newest: places of its own track that are out of reach are twins
    [[nodiscard]] std::vector<RelativePose> resembled(const Trajectory& trajectory,
                                                      const Whereabouts& whereabouts);
    /// The place that the newest keyframe shows; among its own track after resembled(). Waits for the thread.
    [[nodiscard]] std::optional<RecognisedPlace> recognised(Among tracks, const Trajectory& trajectory,
                                                            const Whereabouts& whereabouts);

    /// The keyframe that the frame shows for sure, and its pose relative to that.
    /// @param tracks      among which it is looked for
    /// @param trajectory  with the keyframes
    [[nodiscard]] std::optional<RelativePose> find(const Frame& frame, Among tracks,
                                                   const Trajectory& trajectory,
                                                   const Whereabouts& whereabouts);

    /// The pose about this one that the edges of keyframe and frame, their depths and their surroundings
    /// agree on, if they do (see confirms()).
    /// @param rows  how the frame's moved; where they are taken for still, the keyframe's edges are when the
    ///              frame's are looked for among them
    [[nodiscard]] std::optional<RelativePose> confirm(const Keyframe& keyframe, const Frame& frame,
                                                      const Pose& T_keyframe_camera, const RowMotion& rows);

  private:
    using Alike = std::pair<Verification, int>;  ///< and the keyframe
    struct Described {
        KnownPlace place;
        std::unique_ptr<Frame> frame;  ///< what is registered to older keyframes
        EdgePoints3D edges;
        std::vector<Alike> alike, elsewhere;  ///< in its own track and in others
    };
    static std::optional<RecognisedPlace> surest(const std::vector<RecognisedPlace>& recognised,
                                                 const Trajectory& trajectory,
                                                 const Whereabouts& whereabouts);
    Described describe(Keyframe keyframe, std::unique_ptr<Frame> frame, const std::vector<Rgb>& colours,
                       const std::vector<int>& tracks, int end);
    std::vector<Alike> lookUp(const PlacePoints& points, int query_id,
                              const std::function<bool(int)>& wanted);
    std::vector<RecognisedPlace> registered(const std::vector<Alike>& alike, const Frame& frame,
                                            const EdgePoints3D& edges, const RowMotion& rows);
    void collect();
    Keyframe unpacked(int id) const;
    Likeness likenessOf(int keyframe, const Frame& frame, const Pose& T_frame_keyframe);
    EdgePoints3D lifted(const Frame& frame, const RowMotion& rows) const;

    PinholeCamera camera_, ideal_;
    OdometryOptions options_;  // scaled to the camera
    PlaceDescriber describer_;
    PlaceIndex index_;
    EdgeRegistrar registrar_;         ///< to what is remembered of keyframes
    EdgeRegistrar confirmer_;         ///< to a whole one
    std::vector<KnownPlace> places_;  ///< of each keyframe, by its id
    Described newest_;                ///< keyframe; its place is among places_
    std::exception_ptr failure_;      ///< of the thread, for good
    std::future<Described> at_work_;  // last: waits for the thread
};

}  // namespace roevo
