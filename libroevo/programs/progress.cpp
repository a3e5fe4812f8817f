#include "programs/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace roevo {
namespace {

constexpr double kTerminalPeriod = 0.1;  // s
constexpr double kLogStep = 0.1;         // share of the work
constexpr double kLogMinPeriod = 2;      // s, so that short work does not fill a log
constexpr double kLogPeriod = 10;        // s, when the amount of work is unknown

}  // namespace

std::string durationText(double seconds) {
    const long s = static_cast<long>(seconds + 0.5);
    char text[32];
    if (s >= 3600)
        std::snprintf(text, sizeof text, "%ld h %02ld min", s / 3600, s / 60 % 60);
    else if (s >= 60)
        std::snprintf(text, sizeof text, "%ld min %02ld s", s / 60, s % 60);
    else
        std::snprintf(text, sizeof text, "%ld s", s);
    return text;
}

Progress::Progress(std::string label, std::size_t total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      enabled_(enabled),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_print_(start_) {}

Progress::~Progress() {
    if (!finished_ && printed_ && terminal_) std::fputc('\n', stderr);
}

void Progress::update(std::size_t done, double fraction) {
    done_ = done;
    fraction_ = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : fraction;
    if (!enabled_ || finished_) return;
    const double since_last = std::chrono::duration<double>(Clock::now() - last_print_).count();
    if (terminal_) {
        if (since_last >= kTerminalPeriod) print(false);
    } else if (fraction_ > 0 ? fraction_ >= next_report_ && fraction_ < 1 && since_last >= kLogMinPeriod
                             : since_last >= kLogPeriod) {
        print(false);
        while (next_report_ <= fraction_) next_report_ += kLogStep;
    }
}

void Progress::finish() {
    if (finished_) return;
    finished_ = true;
    if (enabled_) print(true);
}

void Progress::print(bool last) {
    last_print_ = Clock::now();
    const double elapsed = std::chrono::duration<double>(last_print_ - start_).count();
    std::string line = label_ + ": " + std::to_string(done_);
    if (total_ > 0) line += " of " + std::to_string(total_);
    char text[64];
    if (fraction_ > 0 && !last) {
        std::snprintf(text, sizeof text, " (%.0f %%)", 100 * fraction_);
        line += text;
    }
    if (elapsed > 0) {
        std::snprintf(text, sizeof text, ", %.1f/s", static_cast<double>(done_) / elapsed);
        line += text;
    }
    if (last)
        line += ", took " + durationText(elapsed);
    else if (fraction_ > 0 && fraction_ < 1)
        line += ", " + durationText(elapsed * (1 - fraction_) / fraction_) + " left";
    // "\033[K" wipes what a longer line before this one has left.
    std::fprintf(stderr, terminal_ ? (last ? "\r%s\033[K\n" : "\r%s\033[K") : "%s\n", line.c_str());
    std::fflush(stderr);
    printed_ = true;
}

}  // namespace roevo
