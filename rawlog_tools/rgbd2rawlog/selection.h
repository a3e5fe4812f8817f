#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roevo {

/// A moment in a recording as a user gives it: "12.5" is seconds after the first frame, "@1305031453.36" an
/// absolute time stamp.
struct TimeLimit {
    double seconds = 0;
    bool absolute = false;

    /// On the clock of a recording that starts at `first` (s).
    double onClock(double first) const { return absolute ? seconds : first + seconds; }
};

/// @throws UsageError naming the option
TimeLimit parseTimeLimit(const std::string& text, const std::string& option);

/// Which frames of a recording to take.
struct FrameSelection {
    std::optional<TimeLimit> from, to;  ///< both inclusive, to the microsecond
    std::size_t every = 1;  ///< of the frames between them, the first and each so many-th after it

    bool takesAll() const { return !from && !to && every == 1; }
    /// Whether `timestamp` lies between the limits. @param first  s, stamp of the recording's first frame
    bool contains(double timestamp, double first) const;
};

/// Positions of the frames to take, ascending. @param stamps  s, ascending
/// @throws std::runtime_error when none is left, with the time span that there is
std::vector<std::size_t> selectFrames(const std::vector<double>& stamps, const FrameSelection& selection);

}  // namespace roevo
