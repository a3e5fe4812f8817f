#include "programs/interrupt.h"

#include <array>
#include <csignal>

namespace roevo {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t caught = 0;

void remember(int signal) {
    caught = signal;
}

}  // namespace

InterruptGuard::InterruptGuard() {
    caught = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        previous_[i] = std::signal(kSignals[i], remember);
        // Started by nohup: it is to outlive its terminal
        if (kSignals[i] == SIGHUP && previous_[i] == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    }
}

InterruptGuard::~InterruptGuard() {
    caught = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) std::signal(kSignals[i], previous_[i]);
}

void InterruptGuard::check() {
    if (caught != 0) throw Interrupted("interrupted; nothing was written");
}

}  // namespace roevo
