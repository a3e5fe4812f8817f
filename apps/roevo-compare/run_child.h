#pragma once
#include <cstddef>
#include <string>

#include "recordings/input_choice.h"
#include "roevo/options.h"

namespace roevo {

/// One method's run over one recording, in the process that was started for it.
struct ChildSettings {
    std::string method, folder, input;
    InputChoice choice;
    std::size_t skip = 0, first = 0;
    OdometryOptions options;
};

/// Makes the run and keeps it in the folder, as runTasks() expects it of a process.
/// @throws std::exception with the reason, which is kept there, too, when there is no result
void runChild(const ChildSettings& settings);

}  // namespace roevo
