#include "kept_run.h"

#include <csignal>
#include <cstdio>
#include <exception>

namespace roevo {
namespace {

// Signals that a user, a system that is shut down or short of memory, or a batch queue sends; a method that
// fails by itself dies of others.
bool comesFromOutside(int signal) {
    return signal == SIGHUP || signal == SIGINT || signal == SIGKILL || signal == SIGTERM;
}

std::string whyAnew(const MethodRun& run, double timeout_s) {
    char text[96];
    if (run.timeout_s > 0 && run.timeout_s < timeout_s) {
        std::snprintf(text, sizeof text, "it has %g s now instead of %g s", timeout_s, run.timeout_s);
    } else if (comesFromOutside(run.signal)) {
        std::snprintf(text, sizeof text, "it was killed (signal %d)", run.signal);
    } else if (isDisturbed(run)) {
        std::snprintf(text, sizeof text, "other programs had its core for %.0f %% of the time",
                      100 * run.core_lost);
    } else {
        return {};
    }
    return text;
}

}  // namespace

KeptRun findKeptRun(const RunTask& task, double timeout_s) {
    KeptRun kept;
    try {
        MethodRun found = readMethodRun(task.folder);
        if (found.settings != task.settings) return kept;
        found.input = task.input;
        found.label = task.method.label;
        found.note = task.method.note;
        kept.redo = whyAnew(found, timeout_s);
        kept.run = std::move(found);
    } catch (const std::exception&) {  // none, or not whole
    }
    return kept;
}

}  // namespace roevo
