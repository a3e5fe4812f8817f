#pragma once
#include <cstddef>
#include <functional>
#include <string>

#include "method.h"
#include "method_run.h"
#include "recordings/frame_source.h"

namespace roevo {

/// How far a run has come: frames so far, and the share of the recording (0 to 1).
using RunProgress = std::function<void(std::size_t frames, double share)>;

/// Feeds the frames to the method, one after the other in this thread, and sums up what it made of them.
/// Frames that cannot be read or whose stamp cannot be believed, as in the odometry, are rejected.
/// @param first   at most this many frames; 0: all
/// @param folder  gets frames.csv and, where the method has one, map.3Dscene
/// @throws std::runtime_error in one line that names the frame: what the method threw; a pose that is not
/// finite; no frame with a pose
MethodRun runMethod(Method& method, const MethodInfo& info, FrameSource& source, std::size_t first,
                    const std::string& folder, const RunProgress& progress = {});

/// Empty when the pose is finite, else what is wrong with it.
std::string poseFault(const Pose& pose);

}  // namespace roevo
