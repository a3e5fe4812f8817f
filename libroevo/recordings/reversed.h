#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "recordings/frame_source.h"

namespace roevo {

/// A recording from its last frame to its first, with time running forward: stamp t becomes `mirror` - t.
/// For sources that can only be read forwards: it is opened anew for every 64 frames, which are held in
/// memory.
/// @param open  gives the same frames each time
std::unique_ptr<FrameSource> reversedFrames(std::function<std::unique_ptr<FrameSource>()> open,
                                            double mirror);

/// Poses that go with them, in time order as before.
std::vector<StampedPose> reversedPoses(const std::vector<StampedPose>& poses, double mirror);

}  // namespace roevo
