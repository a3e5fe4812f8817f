#pragma once
#include "roevo/edge_map.h"
#include "roevo/options.h"
#include "tracking/tracker.h"

namespace roevo {

/// Whether the frame sees so much less than the keyframe, or from so far away, that it had better become one.
[[nodiscard]] bool keyframeIsDue(const Keyframe& reference, const Tracking& tracking,
                                 const KeyframeOptions& options);

/// How differently a camera at this pose sees than the keyframe: 1 where that alone makes a new one due.
/// @param median_depth  of the keyframe, m
[[nodiscard]] double changeOfView(double median_depth, const Pose& T_keyframe_camera,
                                  const KeyframeOptions& options);

/// Makes a keyframe of a frame. @return why it cannot be one (then `keyframe` is not to be used)
/// @param rows    how the camera moved while the frame was read
/// @param needed  edge points with depth
[[nodiscard]] Fault makeKeyframe(const Frame& frame, const RowMotion& rows, int needed,
                                 const PinholeCamera& camera, const OdometryOptions& options,
                                 const Tracker& tracker, Keyframe& keyframe);

/// Numbers the edges of a new keyframe: those that were tracked as edges of the one before are the same.
/// @param before   nullptr: there is none
/// @param matches  of the frame that becomes the keyframe
/// @param next     next number that is free
void numberEdges(Keyframe& keyframe, const Keyframe* before, const EdgeMatches& matches, std::int32_t& next);

/// The colours of all points of a frame's edges.
/// @param camera  with its lens
std::vector<Rgb> coloursOf(const OrganizedEdges& edges, const RgbdFrame& frame, const PinholeCamera& camera);

}  // namespace roevo
