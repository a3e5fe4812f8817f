#pragma once
#include <string>

namespace roevo {

/// A rendered scene, or why there is none.
struct ScenePicture {
    std::string png;    ///< bytes
    std::string fault;  ///< in words; empty when there is a picture
};

/// Has `roevo-render`, which lies beside the running program, draw a layer of a .3Dscene. Never throws for
/// what is wrong with the scene or the renderer: `fault` says it.
/// @throws Interrupted after a signal (needs an InterruptGuard)
ScenePicture renderScene(const std::string& scene, const std::string& layer);

}  // namespace roevo
