#pragma once
#include <string>

#include "frame_data.h"
#include "roevo/edge_map.h"
#include "roevo/options.h"
#include "roevo/tracking/keyframe.h"

namespace roevo {

/// Makes a keyframe of a frame with a pose. Returns an empty string, or in words why it cannot be one (then
/// `keyframe` is not to be used).
std::string makeKeyframe(const FrameData& data, int id, const PinholeCamera& camera,
                         const OdometryOptions& options, Keyframe& keyframe);

/// The keyframe's edges in the world, coloured from its image.
EdgeMap mapEdgesOf(const Keyframe& keyframe, const RgbdFrame& frame, const PinholeCamera& camera);

}  // namespace roevo
