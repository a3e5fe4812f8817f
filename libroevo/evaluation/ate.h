#pragma once
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/association.h"
#include "evaluation/error_statistics.h"
#include "roevo/types.h"

namespace roevo {

/// Absolute trajectory error (Sturm et al., IROS 2012): distances between camera centres after the
/// alignment of the estimate to the reference.
struct AbsoluteError {
    ErrorStatistics translation;                   ///< m
    Pose T_reference_estimate = Pose::Identity();  ///< the alignment
};

/// @param pairs  at least 3. @param alignment  not with scale: scale the estimate before
/// @throws std::invalid_argument
AbsoluteError absoluteTrajectoryError(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      const std::vector<PosePair>& pairs,
                                      Alignment alignment = Alignment::kSe3);

}  // namespace roevo
