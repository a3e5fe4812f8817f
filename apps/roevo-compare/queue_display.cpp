#include "queue_display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "programs/progress.h"

namespace roevo {
namespace {

// A line that wraps could not be written over.
std::string cutToTerminal(const std::string& line) {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return line;
    return line.substr(0, size.ws_col - 1u);
}

}  // namespace

QueueDisplay::QueueDisplay(const std::vector<RunTask>& tasks, bool enabled)
    : tasks_(tasks), enabled_(enabled), terminal_(isatty(STDERR_FILENO) != 0) {}

QueueDisplay::~QueueDisplay() {
    if (line_open_) std::fputs("\r\033[K", stderr);
}

// Runs differ, so that this is a guess; it gets better as it goes.
std::string QueueDisplay::timeLeft(double done) const {
    const double share = done / static_cast<double>(tasks_.size());
    if (share <= 0 || share >= 1) return {};
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    return ", about " + durationText(elapsed * (1 - share) / share) + " left";
}

void QueueDisplay::finished(std::size_t index, const MethodRun& run, double seconds) {
    ++finished_;
    if (!enabled_) return;
    const RunTask& task = tasks_[index];
    if (!run.not_pinned.empty() && !warned_) {
        std::fprintf(stderr, "%swarning: runs are not pinned to one core: %s\n", line_open_ ? "\r\033[K" : "",
                     run.not_pinned.c_str());
        warned_ = true;
        line_open_ = false;
    }
    char what[96];
    std::snprintf(what, sizeof what, "%zu frames, %.1f ms per frame (median), ", run.frames,
                  run.total.median);
    const std::string result = run.failure.empty() ? what + durationText(seconds) : "FAILED: " + run.failure;
    std::fprintf(stderr, "%s[%zu of %zu] %s, %s: %s%s\n", line_open_ ? "\r\033[K" : "", finished_,
                 tasks_.size(), task.sequence.c_str(), task.method.name.c_str(), result.c_str(),
                 timeLeft(static_cast<double>(finished_) + running_share_).c_str());
    std::fflush(stderr);
    line_open_ = false;
}

void QueueDisplay::going(const std::map<std::size_t, double>& running) {
    running_share_ = 0;
    std::string line;
    for (const auto& [index, share] : running) {
        running_share_ += share;
        char percent[16];
        std::snprintf(percent, sizeof percent, " %.0f %%", 100 * share);
        line +=
            (line.empty() ? "" : "; ") + tasks_[index].sequence + ", " + tasks_[index].method.name + percent;
    }
    if (!enabled_ || !terminal_) return;
    line = "[" + std::to_string(finished_) + " of " + std::to_string(tasks_.size()) + " done" +
           timeLeft(static_cast<double>(finished_) + running_share_) + "] " + line;
    std::fprintf(stderr, "\r%s\033[K", cutToTerminal(line).c_str());
    std::fflush(stderr);
    line_open_ = true;
}

}  // namespace roevo
