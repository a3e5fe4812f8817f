#pragma once
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// Reads a TUM trajectory: `timestamp tx ty tz qx qy qz qw` per line, seconds and metres, `#` starts a
/// comment. Sorted by time on return; a stamp that repeats with the same pose counts once.
/// @throws std::runtime_error with file and line: not eight numbers, a value that is not finite, a quaternion
/// whose
///         length is not one; or a file with no pose at all
std::vector<StampedPose> readTumTrajectory(const std::string& path);

/// A trajectory as programs take it on their command line.
struct NamedFile {
    std::string name;  ///< may be empty
    std::string file;
};

/// "NAME=FILE", or a file alone, which may have a '=' in its own name if it is there.
/// @throws UsageError when there is no name before the '='
NamedFile splitNamedFile(const std::string& argument);

/// Writes a TUM trajectory, the stamp with 6 decimals and the pose with 9; the file appears when whole.
/// @throws std::runtime_error
void writeTumTrajectory(const std::string& path, const std::vector<StampedPose>& poses);

/// One line of such a file, without the end of line.
std::string toTumLine(const StampedPose& pose);

}  // namespace roevo
