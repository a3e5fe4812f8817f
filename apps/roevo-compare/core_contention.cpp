#include "core_contention.h"

#include <algorithm>
#include <chrono>
#include <fstream>

namespace roevo {
namespace {

double now() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Time that this thread has spent ready to run, but waiting for a processor, ms.
double waitedForCore() {
    std::ifstream in("/proc/thread-self/schedstat");  // ns on a processor, ns waiting for one, time slices
    double running = 0, waiting = 0;
    in >> running >> waiting;
    return in ? waiting * 1e-6 : 0;
}

double otherThreads() {
    return processorTime(CLOCK_PROCESS_CPUTIME_ID) - processorTime(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace

double processorTime(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

CoreContention::CoreContention() : start_(now()), delay_(waitedForCore()), others_(otherThreads()) {}

double CoreContention::shareLost() const {
    // The process's own threads share the core, and what they take belongs to the method
    const double lost = waitedForCore() - delay_ - (otherThreads() - others_);
    const double elapsed = now() - start_;
    return elapsed > 0 ? std::clamp(lost / elapsed, 0.0, 1.0) : 0;
}

}  // namespace roevo
