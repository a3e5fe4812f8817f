#pragma once
#include <chrono>

namespace roevo {

class Stopwatch {
  public:
    /// @param clock  tells milliseconds; nullptr: the steady clock
    explicit Stopwatch(double (*clock)() = nullptr)
        : clock_(clock != nullptr ? clock : steady), start_(clock_()) {}
    double milliseconds() const { return clock_() - start_; }

  private:
    static double steady() {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    }
    double (*clock_)();
    double start_;
};

}  // namespace roevo
