#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "method.h"
#include "method_run.h"
#include "programs/process.h"

namespace roevo {

/// One method to be run over one recording.
struct RunTask {
    std::string sequence;  ///< name
    std::string input;     ///< recording, as given
    MethodInfo method;
    std::string folder;  ///< where the run is kept
    std::map<std::string, std::string> settings;
};

struct QueueOptions {
    std::vector<int> cores;  ///< a run at a time on each of them; -1: on any
    double timeout_s = 0;    ///< of a run
};

/// The command that makes a run in the given folder. While it goes on it keeps a ProgressFile there; at the
/// end there is a run.json (see writeMethodRun()), with the result, or with MethodRun::failure when it has
/// failed and knows why. Its exit code is 0 if, and only if, there is a result. What it prints has no
/// meaning; its last line on standard error is quoted where there is no better word.
using CommandFor = std::function<std::vector<std::string>(const RunTask& task, const std::string& folder)>;

/// Who wants to know what is going on.
class QueueObserver {
  public:
    virtual ~QueueObserver() = default;
    /// A run has ended, one way or the other, and is kept in its folder.
    virtual void finished(std::size_t task, const MethodRun& run, double seconds) = 0;
    /// Now and then. @param running  share (0 to 1) of each task that is under way
    virtual void going(const std::map<std::size_t, double>& running) = 0;
};

/// Makes all runs, each in a process of its own. A run that fails (an error, a signal, its time is up) is one
/// with MethodRun::failure. Whatever was in a task's folder is replaced when its run has ended, and stays
/// when it has not.
/// @throws Interrupted after a signal (needs an InterruptGuard), once all processes are ended;
/// std::runtime_error when a run cannot be kept
void runTasks(const std::vector<RunTask>& tasks, const CommandFor& command, const QueueOptions& options,
              QueueObserver& observer);

}  // namespace roevo
