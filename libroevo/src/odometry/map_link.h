#pragma once
#include <deque>
#include <optional>

#include "roevo/mapping/mapping_thread.h"

namespace roevo {

/// The tracker's side of mapping: keyframes go out, and what the map makes of them takes effect a fixed
/// number of frames later (or, unless deterministic, as soon as it is there).
class MapLink {
  public:
    MapLink(const PinholeCamera& camera, const OdometryOptions& options)
        : options_(options.mapping), thread_(camera, options) {}

    void submit(MapJob job, long frame);

    /// The next result that takes effect with this frame, waiting for it if it must; none when there is none.
    std::optional<MapResult> next(long frame, double& waited_ms);

    /// Results that have not taken effect yet, waiting for them; they still will.
    const std::deque<MapResult>& outstanding();

    /// The map of all keyframes that were submitted; waits for it.
    const LocalMapper& finished() const { return thread_.finished(); }

  private:
    MappingOptions options_;
    MappingThread thread_;
    std::deque<long> due_;         // frames with which the results take effect, in order
    std::deque<MapResult> taken_;  // results that came ahead of their time
};

}  // namespace roevo
