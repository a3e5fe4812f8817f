#pragma once
#include <map>

#include "faults.h"
#include "roevo/odometry.h"

namespace roevo::faults {

/// What the odometry made of a stream.
struct Played {
    std::vector<FrameResult> results;
    std::vector<StampedPose> trajectory;
    std::vector<double> jump, allowed;  ///< m; of each frame, see jumps()
};

Played play(const Recording& recording, const std::vector<Shown>& frames,
            const OdometryOptions& options = OdometryOptions());

/// What became of a case, and what was wrong with it.
struct Verdict {
    std::map<std::string, int> statuses;  ///< of the faulty frames; "ok, named" with a reason
    std::string reason;                   ///< of the first faulty frame that has one
    int until_ok = 0;                     ///< frames after the last faulty one until one is ok; -1: none was
    double worst_jump = 0;                ///< m, beyond what its sigma allows, of frames that say nothing
    double worst_named = 0;               ///< m, the same of frames that are ok with a reason
    double ate = 0, clean_ate = 0;        ///< m, over the whole frames
    std::vector<std::string> broken;      ///< promises
};

/// @param count  frames that the fault lasts; what comes after it is held to promises where that is 1 to 10
Verdict judge(const std::vector<Shown>& frames, const Played& played, const Played& clean, Expected expected,
              std::size_t count);

}  // namespace roevo::faults
