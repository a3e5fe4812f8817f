#pragma once
/// Time stamps between seconds and MRPT's clock, exact to the microsecond in both directions, so that a
/// folder and the rawlog made from it carry the same doubles.

#include <mrpt/core/Clock.h>

namespace roevo {

/// The double nearest to `seconds` given to whole microseconds (what "%.6f" prints, read back).
double roundToMicroseconds(double seconds);

/// Seconds since 1970, rounded to microseconds, as MRPT's time. @throws std::runtime_error when not finite or
/// beyond +-1e11 s.
mrpt::Clock::time_point toMrptTime(double seconds);

/// MRPT's time as seconds since 1970, rounded to microseconds.
double fromMrptTime(mrpt::Clock::time_point time);

}  // namespace roevo
