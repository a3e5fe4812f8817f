#pragma once
#include <cstddef>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// Indices of two poses of one moment.
struct PosePair {
    std::size_t reference = 0, estimate = 0;
};

/// Pairs poses by nearest time stamp, one-to-one: of all pairs at most `max_dt` seconds apart the closest is
/// taken first, and a pose that is taken is not used again. Both trajectories sorted by time.
/// @return pairs in time order; possibly none
std::vector<PosePair> associate(const std::vector<StampedPose>& reference,
                                const std::vector<StampedPose>& estimate, double max_dt);

}  // namespace roevo
