#include "rgbd2rawlog/selection.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "programs/program.h"

namespace roevo {
namespace {

constexpr double kHalfMicrosecond = 5e-7;  // stamps are kept to the microsecond

}  // namespace

TimeLimit parseTimeLimit(const std::string& text, const std::string& option) {
    TimeLimit limit;
    limit.absolute = !text.empty() && text.front() == '@';
    const char* const begin = text.c_str() + (limit.absolute ? 1 : 0);
    char* end = nullptr;
    limit.seconds = std::strtod(begin, &end);
    if (end == begin || *end != '\0' || !std::isfinite(limit.seconds))
        throw UsageError(
            option + ": '" + text +
            "' is neither seconds after the first frame (12.5) nor a time stamp (@1305031453.36)");
    return limit;
}

bool FrameSelection::contains(double timestamp, double first) const {
    return (!from || timestamp >= from->onClock(first) - kHalfMicrosecond) &&
           (!to || timestamp <= to->onClock(first) + kHalfMicrosecond);
}

std::vector<std::size_t> selectFrames(const std::vector<double>& stamps, const FrameSelection& selection) {
    std::vector<std::size_t> selected;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < stamps.size(); i++)
        if (selection.contains(stamps[i], stamps.front()) && inside++ % selection.every == 0)
            selected.push_back(i);
    if (selected.empty() && !stamps.empty()) {
        char text[300];
        std::snprintf(
            text, sizeof text,
            "no frame between --from and --to: there are frames from 0 to %.6f s after the first one, "
            "or from @%.6f to @%.6f",
            stamps.back() - stamps.front(), stamps.front(), stamps.back());
        throw std::runtime_error(text);
    }
    return selected;
}

}  // namespace roevo
