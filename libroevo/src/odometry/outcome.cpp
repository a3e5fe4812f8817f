#include "outcome.h"

namespace roevo {

namespace {

std::string whatBecame(const Outcome& outcome) {
    const std::string& why = outcome.tracking.fault.words;
    const std::string keyframe = std::to_string(outcome.found_at);
    if (outcome.status == FrameStatus::kPredicted) return "constant velocity: " + why;
    if (outcome.status == FrameStatus::kLost) return "pose held: " + why;
    if (outcome.status == FrameStatus::kInitialised) {
        if (outcome.lost_frames > 0)
            return "re-anchored after " + std::to_string(outcome.lost_frames) +
                   " frames without tracking: " + why;
        return outcome.found_at < 0 ? "first usable frame" : "found in the map at keyframe " + keyframe;
    }
    if (outcome.found_at >= 0) return "found again at keyframe " + keyframe + ": " + why;
    return outcome.tracking.searched ? "found by searching around the last pose: " + why : "";
}

}  // namespace

std::string describe(const Outcome& outcome, const FrameResult& change) {
    std::string text = whatBecame(outcome);
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (outcome.tracking.tracked && outcome.tracking.depth_fault)
        add(outcome.tracking.depth_fault.words +
            (outcome.tracking.doubtful ? "; the pose is doubtful" : ", and it is left out"));
    if (outcome.not_from_newest)
        add("not found again from the newest keyframe, and doubtful: " + outcome.not_from_newest.words);
    if (change.joined_at >= 0)
        add("the new track is joined to the old one at keyframe " + std::to_string(change.joined_at));
    if (change.closed_at >= 0) add("a loop is closed to keyframe " + std::to_string(change.closed_at));
    if (outcome.no_keyframe) add("a new keyframe is due, but " + outcome.no_keyframe.words);
    return text;
}

FrameResult rejected(double timestamp, const Fault& fault) {
    FrameResult result;
    result.timestamp = timestamp;
    result.reason = fault.words;
    return result;
}

}  // namespace roevo
