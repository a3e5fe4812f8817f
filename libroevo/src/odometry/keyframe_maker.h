#pragma once
#include <string>

#include "frame_data.h"
#include "roevo/edge_map.h"
#include "roevo/mapping/local_mapper.h"
#include "roevo/odometry.h"
#include "roevo/odometry_stages.h"
#include "roevo/options.h"
#include "roevo/tracking/keyframe.h"

namespace roevo {

/// Copies what a keyframe would need of a frame that was not tracked yet.
void keepForKeyframe(const RgbdFrame& frame, const RowMotion& still, FrameData& data);

/// Whether the frame sees so much less than the keyframe, or from so far away, that it had better become one.
bool keyframeIsDue(const Keyframe& keyframe, const FrameResult& result, const KeyframeOptions& options);

/// Makes a keyframe of a frame with a pose. Returns an empty string, or in words why it cannot be one (then
/// `keyframe` is not to be used).
std::string makeKeyframe(const FrameData& data, int id, const PinholeCamera& camera,
                         const OdometryOptions& options, const OdometryStages& stages, Keyframe& keyframe);

/// Brings the keyframe's points to where they are with another motion of its rows.
void setRowMotion(Keyframe& keyframe, const RowMotion& rows);

/// How the rows of a keyframe moved that is the first of its track: that shows only in the next frame, and
/// taken for still it would teach that there is no read-out time. Still where the next frame is too late.
RowMotion firstMotion(const Keyframe& keyframe, const Pose& T_next_keyframe, double next_timestamp);

/// Share of the frames that looked for each edge of the keyframe and found it; negative where too few did.
std::vector<float> foundShares(const Keyframe& keyframe);

/// Gives the keyframe's points the depth and the weight that all keyframes together found, where the update
/// has them. Once per update: both are factors.
void takeFromMap(Keyframe& keyframe, const MapUpdate& update);

/// The keyframe's edges in the world, coloured from its image.
EdgeMap mapEdgesOf(const Keyframe& keyframe, const RgbdFrame& frame, const PinholeCamera& camera);

/// The colours of all points, edge after edge.
std::vector<Rgb> coloursOf(const EdgeMap& edges);

}  // namespace roevo
