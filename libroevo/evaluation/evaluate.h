#pragma once
#include <vector>

#include "evaluation/association.h"
#include "evaluation/ate.h"
#include "evaluation/rpe.h"
#include "roevo/types.h"

namespace roevo {

constexpr double kDefaultMaxDt = 0.02;  ///< s

/// Every error of one trajectory against its reference, by the protocol in docs/formats.md.
struct Evaluation {
    std::vector<PosePair> pairs;
    double scale = 1;  ///< that the estimate was multiplied with before all else
    AbsoluteError ate;
    RelativeError rpe_second;  ///< over 1 s: m/s and deg/s
    RelativeError rpe_frame;   ///< from frame to frame: m and deg
};

/// @param alignment  of the ATE. With scale, that is taken off for the relative errors, too
/// @throws std::runtime_error with the figures that decide (both time ranges, closest stamps, an offset that
/// would fit)
///         when fewer than 3 poses are common, when there is no motion that could tell a scale, or when
///         errors are too large to be squared
Evaluation evaluate(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate,
                    double max_dt = kDefaultMaxDt, Alignment alignment = Alignment::kSe3);

/// The poses in the time of a trajectory and up to kDefaultMaxDt around it.
std::vector<StampedPose> coveredPart(const std::vector<StampedPose>& reference,
                                     const std::vector<StampedPose>& trajectory);

/// Sum of the distances between successive camera centres, m.
double pathLength(const std::vector<StampedPose>& trajectory);

}  // namespace roevo
