#pragma once
#include <string>
#include <vector>

#include "evaluation/association.h"
#include "roevo/types.h"

namespace roevo {

/// What a reference says about an estimate's scale, which SE(3) alignment leaves alone: one line with the
/// factor when the similarity that fits best (Umeyama, PAMI 1991) scales by more than 1.5 either way, as a
/// wrong unit of depth makes it; "" otherwise, and where fewer than 30 pairs, a path of less than 0.3 m or
/// trajectories of differing shape cannot tell.
std::string scaleContradiction(const std::vector<StampedPose>& reference,
                               const std::vector<StampedPose>& estimate, const std::vector<PosePair>& pairs);

}  // namespace roevo
