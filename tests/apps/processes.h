#pragma once
/// Shell scripts as child processes.

#include <sys/types.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/run_program.h"

namespace roevo::test {

inline std::vector<std::string> shell(const std::string& script) {
    return {"/bin/sh", "-c", script};
}

/// Whether there is such a process.
inline bool runs(pid_t id) {
    const std::string status = readFile("/proc/" + std::to_string(id) + "/stat");
    return !status.empty() && status.find(") Z ") == std::string::npos;  // a dead one may not be reaped yet
}

/// Waits for what happens soon.
template <class Condition>
bool soon(const Condition& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) usleep(10'000);
    return condition();
}

}  // namespace roevo::test
