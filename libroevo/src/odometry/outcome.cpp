#include "outcome.h"

namespace roevo {

std::string describe(const Outcome& outcome) {
    const std::string why = describe(outcome.tracking.fault);
    switch (outcome.status) {
        case FrameStatus::kInitialised:
            if (outcome.lost_frames == 0) return "first usable frame";
            return "re-anchored after " + std::to_string(outcome.lost_frames) +
                   " frames without tracking: " + why;
        case FrameStatus::kPredicted:
            return "constant velocity: " + why;
        case FrameStatus::kLost:
            return "pose held: " + why;
        default:
            break;
    }
    std::string text;
    if (outcome.found_at >= 0)
        text = "found again at keyframe " + std::to_string(outcome.found_at) + ": " + why;
    else if (outcome.tracking.searched)
        text = "found by searching around the last pose: " + why;
    if (outcome.joined_at >= 0)
        text += std::string(text.empty() ? "" : "; ") +
                "the new track is joined to the old one at keyframe " + std::to_string(outcome.joined_at);
    if (!outcome.no_keyframe) return text;
    return text + (text.empty() ? "" : "; ") + "a new keyframe is due, but " + describe(outcome.no_keyframe);
}

FrameResult rejected(double timestamp, const Fault& fault, const char* where) {
    FrameResult result;
    result.timestamp = timestamp;
    result.reason = where + describe(fault);
    return result;
}

}  // namespace roevo
