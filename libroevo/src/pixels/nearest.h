#pragma once

namespace roevo {

/// The nearest whole number; of two that are as near, that away from 0. Inline, as std::lround is not.
inline int nearestInteger(double value) {
    return static_cast<int>(value + (value < 0 ? -0.5 : 0.5));
}

}  // namespace roevo
