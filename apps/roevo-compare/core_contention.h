#pragma once
#include <ctime>

namespace roevo {

/// Processor time so far, ms: CLOCK_PROCESS_CPUTIME_ID of all threads, CLOCK_THREAD_CPUTIME_ID of this one.
double processorTime(clockid_t clock);

/// How much a thread that is bound to one core has to wait there for other programs: times per frame that
/// were taken meanwhile are too long. For the thread that makes it.
class CoreContention {
  public:
    CoreContention();

    /// Share (0 to 1) of the time since construction, at least, in which the thread wanted the core and other
    /// programs had it; 0 where the system does not tell.
    double shareLost() const;

  private:
    double start_, delay_, others_;  // ms: time, waiting for a core, processor time of the other threads
};

}  // namespace roevo
