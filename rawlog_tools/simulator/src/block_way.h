#pragma once
#include <vector>

#include "roevo_simulator/scene.h"

namespace roevo::simulator::block {

constexpr double kRingLength = 18, kRingWidth = 14;  // of the centre line, along x and y

/// Way-points once round the block, seen from above counter-clockwise, or the other way round. Both halves of
/// the way are one curve turned by half a turn, so that places which look alike are passed alike.
std::vector<Waypoint> roundTheBlock(bool counter_clockwise);

}  // namespace roevo::simulator::block
