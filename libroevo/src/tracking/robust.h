#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernels/kernels.h"

namespace roevo {

using kernels::kStudentNu;

/// @param values  not empty; are put in another order
template <typename Scalar>
Scalar medianOf(std::vector<Scalar>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Median of numbers that are not negative, as medianOf() finds it. Those with the same leading bits are
/// counted first, so that the processor has no comparisons to guess.
/// @param magnitudes  not empty; are put in another order, and are fewer afterwards
inline float medianOfMagnitudes(std::vector<float>& magnitudes) {
    constexpr int kShift =
        20;  // sign and exponent, and three bits of the mantissa: steps of an eighth at most
    std::array<std::uint32_t, 1 << (31 - kShift)> counts{};
    const auto leading = [](float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        return (bits & 0x7fffffffU) >> kShift;  // in the order of the numbers, as they are not negative
    };
    for (const float value : magnitudes) ++counts[leading(value)];
    std::size_t rank = magnitudes.size() / 2, same = 0;
    std::uint32_t among = 0;
    for (; rank >= counts[among]; ++among) rank -= counts[among];
    for (const float value : magnitudes) {
        magnitudes[same] = value;
        same += leading(value) == among ? 1 : 0;
    }
    magnitudes.resize(same);
    const auto median = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(magnitudes.begin(), median, magnitudes.end());
    return *median;
}

/// Spread (one sigma) of residuals in pixels from the median of their magnitudes, within what edges in real
/// images can have: sub-pixel edges never agree better than 0.1 px. Not to be called without residuals.
/// @param magnitudes  are put in another order, and are fewer afterwards
inline double robustScale(std::vector<float>& magnitudes) {
    constexpr double kMinScale = 0.1, kMaxScale = 2.0;  // px
    return std::clamp(1.4826 * medianOfMagnitudes(magnitudes), kMinScale, kMaxScale);
}

/// `weight` times what iteratively reweighted least squares gives a residual of the t-distribution.
/// @param squared  residual over its spread, squared
/// @param variance  of the residual where `squared` is in its unit and not over its spread
template <typename Scalar>
Scalar studentWeight(Scalar weight, Scalar squared, Scalar variance = 1) {
    return weight * (kStudentNu + 1) / (kStudentNu * variance + squared);
}

/// How fast the pull of residuals grows with them, as a share of their weights: 1 where they are small, less
/// where the t-distribution lets go of some. Of none it is 1.
/// @param slopes  sum of weight (nu - squared) / (nu + squared), squared residuals over their spread
inline double meanSlope(double slopes, double weights) {
    constexpr double kLeastSlope = 0.2;
    return weights > 0 ? std::max(slopes / weights, kLeastSlope) : 1;
}

}  // namespace roevo
