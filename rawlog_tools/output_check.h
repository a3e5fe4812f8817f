#pragma once
#include <string>

namespace roevo {

/// Before any work is done: the rawlog's folder is there and can be written into.
/// @throws std::runtime_error naming the rawlog and its folder
void checkOutputFolder(const std::string& rawlog);

/// For a recording without ground truth: a warning on stderr when <stem>_groundtruth.txt lies beside the
/// rawlog, left there by an older one, since programs that read the rawlog would take it for its own.
void warnOfForeignGroundTruth(const std::string& program, const std::string& rawlog);

/// The same for any `file` that lies beside rawlogs. @param what  that this recording does not have
void warnOfForeignFile(const std::string& program, const std::string& file, const std::string& what);

}  // namespace roevo
