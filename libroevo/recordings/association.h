#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace roevo {

/// A pair of positions in two lists of time stamps.
struct StampMatch {
    std::size_t first = 0, second = 0;
};

struct AssociationReport {
    std::size_t matched = 0;
    std::size_t dropped_colour = 0, dropped_depth = 0;  ///< images left without a partner
    std::size_t duplicates = 0;                         ///< list entries whose stamp was already there
    std::size_t out_of_order = 0;                       ///< list entries earlier than the one before them
    double largest_difference = 0;                      ///< s, between the stamps of a matched pair
    double largest_gap = 0;                             ///< s, between neighbouring matched frames

    std::string toText() const;  ///< one line
};

/// One-to-one association of two ascending lists of time stamps: pairs are taken in the order of their time
/// difference, smallest first (ties: earliest first), each stamp at most once, no pair farther apart than
/// `max_difference`.
/// @return the pairs, ascending in `first`.
std::vector<StampMatch> associateStamps(const std::vector<double>& first, const std::vector<double>& second,
                                        double max_difference);

/// Smallest difference between any two stamps of two ascending lists, infinite when one is empty: for the
/// message when nothing matches.
double smallestDifference(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace roevo
