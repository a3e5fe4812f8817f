#pragma once
#include <list>
#include <memory>
#include <vector>

#include "mapping/local_mapper.h"
#include "roevo/edge_map.h"
#include "tracking/relative_pose.h"

namespace roevo {

/// A keyframe on its way into the map.
struct NewKeyframe {
    const Keyframe& keyframe;
    std::vector<Rgb> colours;  ///< of its points
    Pose T_world_camera = Pose::Identity();
    RelativePose tracked;                ///< from keyframe -1: from none
    const Keyframe* previous = nullptr;  ///< that was tracked against until now, as it is known by now
    double seconds_per_row = 0;          ///< read-out time, as known by now
};

/// Keeps the edges of all keyframes. What becomes of a keyframe takes effect some time later, in the order
/// of insertion.
class Mapper {
  public:
    virtual ~Mapper() = default;

    /// Begins with the keyframes of a map, which are one track; before anything is inserted.
    virtual void load(const std::vector<KeyframeInfo>& poses, std::vector<KeptKeyframe> keyframes) = 0;
    /// The keyframes so far or, where nothing is refined, those that were loaded; waits.
    [[nodiscard]] virtual std::vector<KeptKeyframe> kept() = 0;

    /// @param timestamp  s, of the frame at work
    virtual void insert(NewKeyframe keyframe, double timestamp) = 0;

    /// After what was inserted before.
    virtual void correct(const Correction& correction) = 0;

    /// What takes effect with the frame at this time.
    /// @param waited_ms  grows by the time that was waited for it
    [[nodiscard]] virtual std::vector<MapUpdate> due(double timestamp, double& waited_ms) = 0;
    /// What has not taken effect yet, and still will; waits for it.
    [[nodiscard]] virtual const std::list<MapUpdate>& outstanding() = 0;

    /// What has not taken effect yet, and last what becomes of all keyframes when they are refined together;
    /// waits. From now on it has taken effect.
    [[nodiscard]] virtual std::vector<MapUpdate> refineAll() = 0;

    /// The edges in the world: fused, and as each keyframe saw them. Of all keyframes that were inserted;
    /// waits.
    virtual EdgeMap fusedMap() = 0;
    virtual EdgeMap keyframeEdges() = 0;
};

/// In mode ba one that refines, in a thread of its own; else one that only collects.
[[nodiscard]] std::unique_ptr<Mapper> makeMapper(const PinholeCamera& camera, const OdometryOptions& options);

}  // namespace roevo
