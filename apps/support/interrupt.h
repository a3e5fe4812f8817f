#pragma once
#include <stdexcept>

namespace roevo {

/// The user pressed Ctrl-C, or the program was told to end.
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// For programs that write whole folders: while alive, SIGINT and SIGTERM do not end the program at once but
/// make the next check() throw, so that what is half-written is removed on the way out. One at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// @throws Interrupted after a signal
    static void check();

  private:
    using Handler = void (*)(int);
    Handler previous_int_, previous_term_;
};

}  // namespace roevo
