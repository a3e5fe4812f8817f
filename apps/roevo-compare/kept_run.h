#pragma once
#include <optional>
#include <string>

#include "method_run.h"
#include "run_queue.h"

namespace roevo {

/// What an earlier program has left in a task's folder.
struct KeptRun {
    std::optional<MethodRun> run;  ///< whole, and made with the task's settings
    /// Why it should be made anew all the same: it was killed from outside, other programs had its core, it
    /// has more time now. Empty when it may be taken as it is; a method's own failure may.
    std::string redo;
};

/// @param timeout_s  that a run has now
KeptRun findKeptRun(const RunTask& task, double timeout_s);

}  // namespace roevo
