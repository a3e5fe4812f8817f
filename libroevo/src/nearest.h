#pragma once
#include <algorithm>

namespace roevo {

/// The nearest whole number; of two that are as near, that away from 0. Inline, as std::lround is not.
/// A lens can lead anywhere: what is beyond +-1e9 becomes that, and what is no number is far off, too.
inline int nearestInteger(double value) {
    constexpr double kFarOff = 1e9;
    const double inside = std::min(std::max(-kFarOff, value), kFarOff);  // in this order for NaN
    return static_cast<int>(inside + (inside < 0 ? -0.5 : 0.5));
}

}  // namespace roevo
