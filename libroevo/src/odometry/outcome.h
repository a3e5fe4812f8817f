#pragma once
#include "roevo/frame_result.h"
#include "tracking/tracker.h"

namespace roevo {

/// What became of a frame.
struct Outcome {
    FrameStatus status = FrameStatus::kOk;
    Tracking tracking;          ///< its pose is relative to the present reference
    Fault no_keyframe;          ///< why a keyframe that is due was not made
    Fault not_from_newest;      ///< why the frame was not tracked from the keyframe that it brought
    bool is_keyframe = false;   ///< the frame is the reference now
    bool new_keyframe = false;  ///< this frame brought a new keyframe: itself or the frame before it
    int lost_frames = 0;        ///< until this one
    int found_at = -1;          ///< keyframe that a lost frame was recognised by

    bool hasMeasuredPose() const { return status != FrameStatus::kPredicted && status != FrameStatus::kLost; }
};

/// The reason of a frame's status, and what became of the world, in words.
/// @param change    see World::changes()
/// @param first_in  keyframes below this are those of a map that was loaded, in which the camera is for the
///                  first time; else 0
std::string describe(const Outcome& outcome, const FrameResult& change, int first_in);

/// A frame that is not processed.
FrameResult rejected(double timestamp, const Fault& fault);

}  // namespace roevo
