#pragma once
#include <string>
#include <vector>

#include "roevo/tracking/fine_tracker.h"

namespace roevo {

/// Rotations about the camera's x and y axes around a pose, as far as half the field of view: where to look
/// when the camera was turned faster than the trackers converge.
std::vector<Pose> searchAround(const Pose& T_current_keyframe);

/// Why fine tracking failed, in words.
std::string lackOf(const FineResult& refined, const FineOptions& options);

}  // namespace roevo
