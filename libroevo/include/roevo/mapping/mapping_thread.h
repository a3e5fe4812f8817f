#pragma once
#include <memory>
#include <vector>

#include "roevo/mapping/local_mapper.h"

namespace roevo {

/// A keyframe on its way into the map.
struct MapJob {
    MapKeyframe keyframe;
    int previous = -1;           ///< keyframe that was tracked before, -1: none
    std::vector<float> found;    ///< MapKeyframe::found of `previous`
    RowMotion previous_rows;     ///< of `previous`, as known by now
    double seconds_per_row = 0;  ///< read-out time, as known by now
};

struct MapResult {
    MapUpdate update;
    double milliseconds = 0;  ///< that the mapper worked on it
};

/// Runs a LocalMapper beside the tracker. Jobs are done in the order of submission, one at a time, so that
/// the results do not depend on threads; when they take effect is up to the caller. All functions are for one
/// caller's thread.
class MappingThread {
  public:
    MappingThread(const PinholeCamera& camera, const OdometryOptions& options);
    ~MappingThread();
    MappingThread(const MappingThread&) = delete;
    MappingThread& operator=(const MappingThread&) = delete;

    /// Waits while too many jobs wait already.
    void submit(MapJob job);

    /// Results that were not taken yet, done or not.
    int pending() const;
    /// Whether take() would not wait.
    bool ready() const;
    /// The oldest result; waits for it. Call only while pending() > 0. @throws what the mapper threw
    MapResult take();

    /// The map, once all submitted jobs are done; valid to read until the next submit().
    const LocalMapper& finished() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
