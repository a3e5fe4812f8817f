#pragma once
#include <vector>

#include "evaluation/association.h"
#include "evaluation/error_statistics.h"
#include "roevo/types.h"

namespace roevo {

/// Relative pose error: what remains of the motion from pose i to pose j when the reference's is taken off.
/// Free of any alignment.
struct RelativeError {
    ErrorStatistics translation;  ///< m per interval
    ErrorStatistics rotation;     ///< degrees per interval
};

/// Over `interval` seconds: i is every pair, j the pair nearest to t_i + interval by the estimate's clock,
/// left out when none is within a tenth of the interval or the trajectory ends before it. Empty statistics
/// when the trajectory is shorter than that.
RelativeError relativePoseErrorOverTime(const std::vector<StampedPose>& reference,
                                        const std::vector<StampedPose>& estimate,
                                        const std::vector<PosePair>& pairs, double interval);

/// Over `length` m of the reference's path, as KITTI's benchmark does: i is every pair, j the one behind it
/// by the path that is nearest to that, left out when none is within a tenth of it. Errors are divided by the
/// path from i to j: m/m and degrees/m.
RelativeError relativePoseErrorOverDistance(const std::vector<StampedPose>& reference,
                                            const std::vector<StampedPose>& estimate,
                                            const std::vector<PosePair>& pairs, double length);

/// From each pair to the next.
RelativeError relativePoseErrorPerFrame(const std::vector<StampedPose>& reference,
                                        const std::vector<StampedPose>& estimate,
                                        const std::vector<PosePair>& pairs);

}  // namespace roevo
