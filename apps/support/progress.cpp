#include "support/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace roevo {
namespace {

constexpr double kTerminalPeriod = 0.1;  // s
constexpr double kLogPeriod = 10;        // s, only when the total is unknown

std::string duration(double seconds) {
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

}  // namespace

Progress::Progress(std::string label, std::size_t total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      next_report_((total + 9) / 10),
      enabled_(enabled),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_print_(start_) {}

Progress::~Progress() {
    if (!finished_ && printed_ && terminal_) std::fputc('\n', stderr);
}

void Progress::update(std::size_t done) {
    done_ = done;
    if (!enabled_ || finished_) return;
    const double since_last = std::chrono::duration<double>(Clock::now() - last_print_).count();
    if (terminal_) {
        if (since_last >= kTerminalPeriod) print(done, false);
    } else if (total_ > 0 ? done >= next_report_ && done < total_ : since_last >= kLogPeriod) {
        print(done, false);
        while (next_report_ <= done) next_report_ += std::max<std::size_t>(1, (total_ + 9) / 10);
    }
}

void Progress::finish() {
    if (finished_) return;
    finished_ = true;
    if (enabled_) print(done_, true);
}

void Progress::print(std::size_t done, bool last) {
    last_print_ = Clock::now();
    const double elapsed = std::chrono::duration<double>(last_print_ - start_).count();
    const double rate = elapsed > 0 ? static_cast<double>(done) / elapsed : 0;
    std::string line = label_ + ": " + std::to_string(done);
    if (total_ > 0) {
        char percent[16];
        std::snprintf(percent, sizeof percent, " (%3.0f %%)",
                      100.0 * static_cast<double>(done) / static_cast<double>(total_));
        line += " of " + std::to_string(total_) + percent;
    }
    char speed[32];
    std::snprintf(speed, sizeof speed, ", %.1f/s", rate);
    line += speed;
    if (last)
        line += ", took " + duration(elapsed);
    else if (total_ > done && rate > 0)
        line += ", " + duration(static_cast<double>(total_ - done) / rate) + " left";
    // "\033[K" wipes what a longer line before this one has left.
    std::fprintf(stderr, terminal_ ? (last ? "\r%s\033[K\n" : "\r%s\033[K") : "%s\n", line.c_str());
    std::fflush(stderr);
    printed_ = true;
}

}  // namespace roevo
