#pragma once
#include <cstddef>
#include <string>

#include "roevo/options.h"
#include "sequences.h"

namespace roevo {

/// One method's run over one recording, in the process that was started for it.
struct ChildSettings {
    std::string method;      ///< with its variant
    std::string trajectory;  ///< file of another program's poses, in place of the method's; else empty
    std::string folder;
    SequenceInput sequence;
    OdometryOptions options;
    double memory_mb = 0;  ///< that it may have; 0: no limit
};

/// Makes the run and keeps it in the folder, as supervisedRun() expects it of a process.
/// @throws std::exception with the reason, which is kept there, too, when there is no result
void runChild(const ChildSettings& settings);

}  // namespace roevo
