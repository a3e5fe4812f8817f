#pragma once
#include <array>
#include <optional>
#include <vector>

#include "repeatability/measure.h"

namespace roevo {

/// How far a frame is from its reference.
enum class Distance { kFrames, kRotation, kTranslation };
double distanceOf(const RepeatabilityRow& row, Distance distance);  ///< frames, degrees, m

/// Rows of about the same distance from their reference.
struct DistanceBin {
    double from = 0, to = 0;  ///< in the distance's unit; rows with from < distance <= to
    std::size_t rows = 0;
    std::array<std::optional<double>, kNumAssociationMethods> share;  ///< mean over the rows that have one

    double middle() const { return (from + to) / 2; }
};

/// Bins of a round width (1, 2 or 5 times a power of ten), at most about 20 of them; empty ones are left out.
std::vector<DistanceBin> binRows(const std::vector<RepeatabilityRow>& rows, Distance distance);

/// Mean share of each method over the rows between two distances in frames, both included.
std::array<std::optional<double>, kNumAssociationMethods> meanShares(
    const std::vector<RepeatabilityRow>& rows, double from, double to);

}  // namespace roevo
