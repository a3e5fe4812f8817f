#pragma once
#include <array>
#include <stdexcept>

namespace roevo {

/// The user pressed Ctrl-C, closed the terminal, or the program was told to end.
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// For programs that write whole folders: while alive, SIGINT, SIGTERM and SIGHUP (unless it is ignored)
/// do not end the program at once but make the next check() throw, so that what is half-written is removed on
/// the way out. One at a time.
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
    std::array<Handler, 3> previous_;
};

}  // namespace roevo
