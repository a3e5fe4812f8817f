#pragma once
#include <functional>
#include <string>
#include <vector>

#include "method.h"
#include "report/comparison.h"
#include "run_progress.h"

namespace roevo {

/// One method to be run over one recording.
struct RunTask {
    std::string sequence;  ///< name
    std::string input;     ///< recording, as given
    MethodInfo method;
    std::string folder;    ///< where the run is kept
    double timeout_s = 0;  ///< after which it is ended
    std::string key{};     ///< see MethodRun
};

/// The command that makes a run in the given folder. While it goes on it keeps a ProgressFile there; at the
/// end there is a row (see rows.h), with the result, or with MethodRun::failure when it has failed and knows
/// why. Its exit code is 0 if, and only if, there is a result. What it prints has no meaning; its last line
/// on standard error is quoted where there is no better word.
using CommandFor = std::function<std::vector<std::string>(const std::string& folder)>;

/// Makes the run in a process of its own, on a core of its own. One that fails (an error, a signal, its time
/// is up) is a row with MethodRun::failure. Whatever was in the task's folder is replaced when the run has
/// ended, and stays when it has not. Several programs may be at work in one folder.
/// @param going  is told now and then how far it is
/// @return the row @throws Interrupted after a signal (needs an InterruptGuard), once the process is ended;
/// std::runtime_error when the run cannot be kept
SequenceComparison supervisedRun(const RunTask& task, const CommandFor& command,
                                 const std::function<void(const Advance&)>& going = {});

}  // namespace roevo
