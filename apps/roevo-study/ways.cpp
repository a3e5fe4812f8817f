#include "ways.h"

#include "inputs.h"
#include "recordings/reversed.h"

namespace roevo {
namespace {

constexpr std::size_t kStarts[] = {0, 3, 6, 9, 12};  // frames

}  // namespace

std::string Way::name() const {
    const std::string direction = backwards ? "backwards" : "forwards";
    return start == 0 ? direction : direction + " from frame " + std::to_string(start);
}

std::vector<Way> waysThrough(const StudyInput& input) {
    std::size_t frames = 0;
    for (const auto source = input.open(); source->skip();) ++frames;
    std::vector<Way> ways;
    for (const bool backwards : {false, true})
        for (const std::size_t start : kStarts)
            if (start + kFewestFrames <= frames) ways.push_back({backwards, start});
    return ways;
}

StudyInput along(const StudyInput& input, const Way& way) {
    StudyInput other = input;
    const double mirror = input.ground_truth.front().timestamp + input.ground_truth.back().timestamp;
    if (way.backwards) other.ground_truth = reversedPoses(input.ground_truth, mirror);
    other.open = [open = input.open, way, mirror] {
        auto source = way.backwards ? prefetch(reversedFrames(open, mirror)) : open();
        for (std::size_t i = 0; i < way.start; ++i) source->skip();
        return source;
    };
    return other;
}

}  // namespace roevo
