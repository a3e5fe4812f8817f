#include "support/interrupt.h"

#include <csignal>

namespace roevo {
namespace {

volatile std::sig_atomic_t caught = 0;

void remember(int signal) {
    caught = signal;
}

}  // namespace

InterruptGuard::InterruptGuard()
    : previous_int_(std::signal(SIGINT, remember)), previous_term_(std::signal(SIGTERM, remember)) {
    caught = 0;
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, previous_int_);
    std::signal(SIGTERM, previous_term_);
}

void InterruptGuard::check() {
    if (caught != 0) throw Interrupted("interrupted; nothing was written");
}

}  // namespace roevo
