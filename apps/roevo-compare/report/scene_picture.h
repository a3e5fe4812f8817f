#pragma once
#include <string>
#include <utility>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// What `roevo-render`, which lies beside the running program, has made, or why there is nothing.
struct Rendered {
    std::string bytes;
    std::string fault;  ///< in words; empty when there are bytes
};

/// Has it draw a layer of a .3Dscene, as PNG. Never throws for what is wrong with the scene or the renderer:
/// `fault` says it.
/// @throws Interrupted after a signal (needs an InterruptGuard)
Rendered renderScene(const std::string& scene, const std::string& layer);

/// Folder of a run with its trajectory.txt and, where it has one, its map; what the recording and it are
/// called.
struct ViewedRun {
    std::string folder, recording, name;
};
using NamedTrajectories = std::vector<std::pair<std::string, std::vector<StampedPose>>>;

/// Has it make a page to look around in: the run's map, its trajectory, others beside it.
/// @param truth  may be empty. @throws as renderScene()
Rendered renderView(const ViewedRun& run, const NamedTrajectories& others,
                    const std::vector<StampedPose>& truth);

}  // namespace roevo
