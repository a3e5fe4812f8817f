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

/// Neither no number nor one that does not fit into MRPT's clock.
bool isUsable(double seconds) {
    return std::abs(seconds) < 1e11;
}

/// To the nearest, of two as printf() does. Whole seconds apart, since the product of all of it would be
/// rounded, too.
std::int64_t toMicroseconds(double seconds) {
    const double whole = std::floor(seconds);
    return static_cast<std::int64_t>(whole) * static_cast<std::int64_t>(kMicrosecondsPerSecond) +
           static_cast<std::int64_t>(std::nearbyint((seconds - whole) * kMicrosecondsPerSecond));
}

}  // namespace

double roundToMicroseconds(double seconds) {
    if (!isUsable(seconds)) return seconds;
    return static_cast<double>(toMicroseconds(seconds)) / kMicrosecondsPerSecond;
}

mrpt::Clock::time_point toMrptTime(double seconds) {
    if (!isUsable(seconds))
        throw std::runtime_error("time stamp " + std::to_string(seconds) + " s is not a usable time");
    // Through integers: seconds times 1e7 does not fit the 53 bits of a double for present-day dates.
    return mrpt::Clock::time_point(
        mrpt::Clock::duration(epochTicks() + toMicroseconds(seconds) * kTicksPerMicrosecond));
}

double fromMrptTime(mrpt::Clock::time_point time) {
    const std::int64_t ticks = time.time_since_epoch().count() - epochTicks();
    const std::int64_t half = kTicksPerMicrosecond / 2;
    const std::int64_t microseconds = (ticks + (ticks >= 0 ? half : -half)) / kTicksPerMicrosecond;
    return static_cast<double>(microseconds) / kMicrosecondsPerSecond;
}

}  // namespace roevo
