#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "roevo/types.h"

namespace roevo {

constexpr double kClockJitter = 2e-3;       ///< s: time stamps of one moment differ by less
constexpr double kIntervalTolerance = 0.1;  ///< share of an interval that its end may be off

/// A pair of positions in two lists of time stamps.
struct StampMatch {
    std::size_t first = 0, second = 0;
};

/// The time stamps of a list of entries.
template <class Entry>
std::vector<double> stampsOf(const std::vector<Entry>& entries) {
    std::vector<double> stamps;
    for (const Entry& entry : entries) stamps.push_back(entry.timestamp);
    return stamps;
}

/// One-to-one association of two ascending lists of time stamps: pairs are taken in the order of their time
/// difference, smallest first (ties: earliest first), each stamp at most once, no pair farther apart than
/// `max_difference`.
/// @return the pairs, ascending in `first`.
std::vector<StampMatch> associateStamps(const std::vector<double>& first, const std::vector<double>& second,
                                        double max_difference);

/// Smallest difference between any two stamps of two ascending lists, infinite when one is empty: for the
/// message when nothing matches.
double smallestDifference(const std::vector<double>& first, const std::vector<double>& second);

/// Indices of two poses of one moment.
struct PosePair {
    std::size_t reference = 0, estimate = 0;
};

/// Pairs poses by time stamp, see associateStamps(). Both trajectories sorted by time.
/// @return pairs in time order; possibly none
std::vector<PosePair> associate(const std::vector<StampedPose>& reference,
                                const std::vector<StampedPose>& estimate, double max_dt);

/// Where a trajectory, sorted by time, was at a time: between its two poses around it, which are at most
/// 0.1 s apart, as if the camera had moved evenly. None elsewhere; ends reach 2 ms further.
std::optional<Pose> poseAt(const std::vector<StampedPose>& trajectory, double time);

}  // namespace roevo
