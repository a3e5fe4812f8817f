#include "outcome.h"

namespace roevo {

namespace {

std::string whatBecame(const Outcome& outcome, const std::string& found) {
    const std::string& why = outcome.tracking.fault.words;
    if (outcome.status == FrameStatus::kPredicted) return "constant velocity: " + why;
    if (outcome.status == FrameStatus::kLost) return "pose held: " + why;
    if (outcome.status == FrameStatus::kInitialised) {
        if (outcome.lost_frames > 0)
            return "re-anchored after " + std::to_string(outcome.lost_frames) +
                   " frames without tracking: " + why;
        return outcome.found_at < 0 ? "first usable frame" : found;
    }
    if (outcome.found_at >= 0) return found + ": " + why;
    return outcome.tracking.searched ? "found by searching around the last pose: " + why : "";
}

}  // namespace

std::string describe(const Outcome& outcome, const FrameResult& change, int first_in) {
    const auto at = [&](int keyframe, const char* elsewhere) {
        return (keyframe < first_in ? "found in the map" : elsewhere) +
               (" at keyframe " + std::to_string(keyframe));
    };
    std::string text = whatBecame(outcome, at(outcome.found_at, "found again"));
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (outcome.tracking.tracked && outcome.tracking.depth_fault)
        add(outcome.tracking.depth_fault.words +
            (outcome.tracking.doubtful ? "; the pose is doubtful" : ", and it is left out"));
    if (outcome.not_from_newest)
        add("not found again from the newest keyframe, and doubtful: " + outcome.not_from_newest.words);
    if (change.joined_at >= 0) add(at(change.joined_at, "the new track is joined to the old one"));
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
