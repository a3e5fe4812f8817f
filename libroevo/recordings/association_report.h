#pragma once
#include <cstddef>
#include <string>

namespace roevo {

/// How the images of a recording were matched.
struct AssociationReport {
    std::size_t matched = 0;
    std::size_t dropped_colour = 0, dropped_depth = 0;  ///< images left without a partner
    std::size_t duplicates = 0;                         ///< list entries whose stamp was already there
    std::size_t out_of_order = 0;                       ///< list entries earlier than the one before them
    double largest_difference = 0;                      ///< s, between the stamps of a matched pair
    double largest_gap = 0;                             ///< s, between neighbouring matched frames

    std::string toText() const;  ///< one line
};

}  // namespace roevo
