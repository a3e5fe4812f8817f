#include "outcome.h"

namespace roevo {

namespace {

std::string whatBecame(const Outcome& outcome) {
    const std::string why = describe(outcome.tracking.fault);
    switch (outcome.status) {
        case FrameStatus::kInitialised:
            if (outcome.lost_frames == 0)
                return outcome.found_at < 0
                           ? "first usable frame"
                           : "found in the map at keyframe " + std::to_string(outcome.found_at);
            return "re-anchored after " + std::to_string(outcome.lost_frames) +
                   " frames without tracking: " + why;
        case FrameStatus::kPredicted:
            return "constant velocity: " + why;
        case FrameStatus::kLost:
            return "pose held: " + why;
        default:
            break;
    }
    if (outcome.found_at >= 0)
        return "found again at keyframe " + std::to_string(outcome.found_at) + ": " + why;
    return outcome.tracking.searched ? "found by searching around the last pose: " + why : "";
}

}  // namespace

std::string describe(const Outcome& outcome, const FrameResult& change) {
    std::string text = whatBecame(outcome);
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (outcome.tracking.tracked && outcome.tracking.depth_fault)
        add(describe(outcome.tracking.depth_fault) +
            (outcome.tracking.doubtful ? "; the pose is doubtful" : ", and it is left out"));
    if (outcome.not_from_newest)
        add("not found again from the newest keyframe, and doubtful: " + describe(outcome.not_from_newest));
    if (change.joined_at >= 0)
        add("the new track is joined to the old one at keyframe " + std::to_string(change.joined_at));
    if (change.closed_at >= 0) add("a loop is closed to keyframe " + std::to_string(change.closed_at));
    if (outcome.no_keyframe) add("a new keyframe is due, but " + describe(outcome.no_keyframe));
    return text;
}

FrameResult rejected(double timestamp, const Fault& fault) {
    FrameResult result;
    result.timestamp = timestamp;
    result.reason = describe(fault);
    return result;
}

}  // namespace roevo
