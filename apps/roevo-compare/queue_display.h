#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "run_queue.h"

namespace roevo {

/// Shows on stderr how the runs go: a line for each that has ended and, on a terminal, one below them that
/// follows those under way, with the time left.
class QueueDisplay : public QueueObserver {
  public:
    /// @param tasks  outlive this object
    QueueDisplay(const std::vector<RunTask>& tasks, bool enabled);
    ~QueueDisplay() override;

    void finished(std::size_t task, const MethodRun& run, double seconds) override;
    void going(const std::map<std::size_t, double>& running) override;

  private:
    using Clock = std::chrono::steady_clock;
    std::string timeLeft(double done) const;

    const std::vector<RunTask>& tasks_;
    const bool enabled_, terminal_;
    std::size_t finished_ = 0;
    bool line_open_ = false, warned_ = false;
    const Clock::time_point start_ = Clock::now();
    double running_share_ = 0;
};

}  // namespace roevo
