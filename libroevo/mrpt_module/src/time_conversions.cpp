#include "roevo_mrpt/time_conversions.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace roevo {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;
constexpr std::int64_t kTicksPerMicrosecond = 10;  // MRPT counts units of 100 ns

std::int64_t epochTicks() {
    return mrpt::Clock::fromDouble(0.0).time_since_epoch().count();
}

}  // namespace

double roundToMicroseconds(double seconds) {
    return std::round(seconds * kMicrosecondsPerSecond) / kMicrosecondsPerSecond;
}

mrpt::Clock::time_point toMrptTime(double seconds) {
    if (!(std::abs(seconds) < 1e11))
        throw std::runtime_error("time stamp " + std::to_string(seconds) + " s is not a usable time");
    // Through integers: seconds times 1e7 does not fit the 53 bits of a double for present-day dates.
    const auto microseconds = static_cast<std::int64_t>(std::round(seconds * kMicrosecondsPerSecond));
    return mrpt::Clock::time_point(mrpt::Clock::duration(epochTicks() + microseconds * kTicksPerMicrosecond));
}

double fromMrptTime(mrpt::Clock::time_point time) {
    const std::int64_t ticks = time.time_since_epoch().count() - epochTicks();
    const std::int64_t half = kTicksPerMicrosecond / 2;
    const std::int64_t microseconds = (ticks + (ticks >= 0 ? half : -half)) / kTicksPerMicrosecond;
    return static_cast<double>(microseconds) / kMicrosecondsPerSecond;
}

}  // namespace roevo
