#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mapping/bundle_adjustment.h"
#include "mapping/covisibility.h"
#include "mapping/edge_fusion.h"
#include "mapping/packed_keyframe.h"
#include "mapping/pose_graph.h"
#include "mapping/pseudo_edges.h"
#include "mapping/window_posterior.h"
#include "roevo/frame_result.h"

namespace roevo {

/// Keyframes of a long track that are refined together at its end. In a room that they see again and again
/// their equations are dense, and take the cube of their number.
constexpr std::size_t kMostTogether = 200;

/// What mapping found when a keyframe was inserted.
struct MapUpdate {
    int keyframe = 0;                         ///< the inserted one
    std::vector<std::pair<int, Pose>> poses;  ///< T_world_camera of all keyframes that were refined
    std::vector<EdgeVerdict> verdicts;  ///< of the inserted keyframe's edges; empty while it is the only one
    int reused = 0;                     ///< old keyframes that took part
    std::vector<MapRefusal> refusals;
    std::optional<WindowPosterior> posterior;       ///< where older keyframes took part
    double milliseconds = 0, cpu_milliseconds = 0;  ///< of work on it
};

/// How keyframes move when a place is recognised: a whole track to where it belongs, or each as a loop wants.
struct Correction {
    std::map<int, Pose> motions;  ///< by keyframe, of the world: T_world_camera <- motion * T_world_camera
    /// What was recognised. Those that move belong to the track of the first one's `from` from now on.
    std::vector<PoseConstraint> places;
};

/// What mapping knows of a keyframe besides its pose, as it is kept in a file.
struct KeptKeyframe {
    PackedKeyframe points;
    double median_depth = 0;            ///< m
    RowMotion row_motion;               ///< that the points were moved with
    std::vector<float> found;           ///< see MapKeyframe::found
    std::vector<EdgeVerdict> verdicts;  ///< of each edge; empty: none yet
    std::vector<CovisibilityGraph::Links> links;
};

inline constexpr double kDriftScale = 0.5;  ///< px of spread that drift may cause at first

/// Local mapping: keeps the keyframes, relates the edges of a new one to those of its neighbours, fuses them
/// and refines the poses of the window. No threads, no clocks: the same keyframes give the same map.
class LocalMapper {
  public:
    LocalMapper(const PinholeCamera& camera, const OdometryOptions& options);

    /// A keyframe of a map that was made before, in the order of their ids, all of one track. Later ones are
    /// related to it, and it stays where it is but for corrections.
    void load(const KeyframeInfo& info, KeptKeyframe kept);
    /// All keyframes, in the order of their ids.
    std::vector<KeptKeyframe> kept() const;

    MapUpdate insert(MapKeyframe keyframe);

    void correct(const Correction& correction);

    /// Refines all keyframes of each track together, but for the first one and those that were loaded. Edges,
    /// which are related anew, and places that were recognised hold them. Which edges are pseudo-edges stays
    /// as it was judged. Longer tracks than `most_together`, two at least, are refined in parts that overlap
    /// by half.
    MapUpdate refineAll(std::size_t most_together = kMostTogether);

    /// What the frames after a keyframe told of it; before the next insert(). Of one that there is not:
    /// nothing.
    /// @param found  see MapKeyframe::found
    /// @param rows   how its rows moved, where that was not known when it was inserted
    void learnOf(int keyframe, std::vector<float> found, const RowMotion& rows);
    /// Read-out time that all keyframes are brought to as they take part.
    void setReadout(double seconds_per_row) { seconds_per_row_ = seconds_per_row; }

    /// All of them at their present poses; points only of the newest, which the next window begins with.
    const std::map<int, MapKeyframe>& keyframes() const { return keyframes_; }

    /// All keyframes' edges fused at the present poses (Eqs. (14)-(16)).
    EdgeMap fusedMap() const;
    /// The edges of each keyframe as it saw them, with the cluster that they belong to.
    EdgeMap keyframeEdges() const;

  private:
    std::vector<const MapKeyframe*> recentOf(const MapKeyframe& newest) const;
    void unpack(MapKeyframe& keyframe) const;
    bool bringToReadout(MapKeyframe& keyframe) const;
    void prepare(const std::vector<const MapKeyframe*>& members);
    void leaveWindow(MapKeyframe& newest);
    std::map<int, MapKeyframe> unpacked() const;
    std::vector<const MapKeyframe*> nearbyOf(const MapKeyframe& keyframe,
                                             const std::vector<const MapKeyframe*>& recent) const;
    /// A keyframe and those that its edges are related to: the ones just before it, and older ones that see
    /// about the same.
    struct Neighbourhood {
        const MapKeyframe* of;
        std::vector<const MapKeyframe*> recent, nearby;
    };
    Neighbourhood neighbourhoodOf(const MapKeyframe& keyframe) const;
    void relate(const Neighbourhood& neighbourhood, double radius);
    void setWindow(const std::vector<const MapKeyframe*>& members, std::size_t begin, std::size_t end);
    int slotOf(int keyframe) const;
    void takePoses(const std::vector<int>& inliers, MapUpdate& update);
    void refineTogether(const std::vector<const MapKeyframe*>& track, std::size_t begin, std::size_t end,
                        BundleAdjuster& adjuster, MapUpdate& update);
    std::optional<MapRefusal> refusalOf(const WindowKeyframe& view, int inliers) const;
    void addPriors();
    void addRecognisedPlaces();
    void keepVerdicts();
    static void takeKeptVerdicts(const std::vector<WindowKeyframe>& window, FusedEdges& edges);
    std::vector<std::int32_t> trackedClusters() const;

    PinholeCamera camera_;
    OdometryOptions options_;
    CovisibilityGraph graph_;
    EdgeFuser fuser_;
    BundleAdjuster adjuster_;
    PseudoEdgeJudge judge_;
    std::map<int, MapKeyframe> keyframes_;
    std::map<int, PackedKeyframe> packed_;  ///< the points of those that have left the window once
    double seconds_per_row_ = 0;            ///< see setReadout()
    std::vector<WindowKeyframe> window_;
    std::vector<RelativePrior> priors_;
    std::vector<PoseConstraint> places_;  ///< that were recognised
    FusedEdges fused_;
    int loaded_ = 0;  ///< keyframes, the first ones
};

}  // namespace roevo
