#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace roevo {

/// A time span for people: "12 s", "3 min 05 s", "1 h 02 min".
std::string durationText(double seconds);

/// Progress of long work, on stderr: one self-updating line with the time left on a terminal, a plain line
/// about every 10 % (or every 10 s when it is not known how much there is) in a log.
class Progress {
  public:
    /// @param total    number of steps, 0 when unknown
    /// @param enabled  false keeps it silent
    Progress(std::string label, std::size_t total, bool enabled = true);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// @param done      steps completed so far
    /// @param fraction  share of the work done, 0 to 1, for work whose number of steps is not known
    void update(std::size_t done, double fraction = 0);

    /// Prints the last line, with the time taken. Without it the destructor only ends the line on a terminal,
    /// so that an error message starts on one of its own.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    void print(bool last);

    std::string label_;
    std::size_t total_, done_ = 0;
    double fraction_ = 0, next_report_ = 0.1;
    bool enabled_, terminal_, finished_ = false, printed_ = false;
    Clock::time_point start_, last_print_;
};

}  // namespace roevo
