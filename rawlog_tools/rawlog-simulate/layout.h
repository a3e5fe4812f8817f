#pragma once
#include <string>
#include <vector>

#include "roevo_simulator/simulator.h"

namespace roevo {

/// What --layout can be.
const std::vector<std::string>& layoutNames();

/// Gives the simulation the cameras that a layout prescribes: ICL-NUIM's (scaled to the size, unless
/// intrinsics were given) and 7-Scenes' two.
/// @return empty, or why the layout cannot hold such a simulation, with what to change
std::string applyLayout(const std::string& layout, simulator::SimulationOptions& options);

/// ICL-NUIM's published camera, with the rows counted downwards, scaled from 640x480.
PinholeCamera iclCamera(int width, int height);

/// Number of a frame in layouts that count at 30 Hz.
long frameNumber(double timestamp);

extern const char kTruthHeader[];

/// A line of a TUM trajectory.
std::string truthLine(double timestamp, const Pose& T_world_camera);

}  // namespace roevo
