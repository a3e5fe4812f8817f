#pragma once
#include <cstdint>
#include <vector>

#include "place/place_points.h"

namespace roevo {

struct PlaceMatch {
    std::int32_t query = 0, candidate = 0;  ///< indices of points
    std::int32_t distance = 0;              ///< bits that differ
};

/// Pairs of points, each of which is the other's most similar one, and more so than any that is somewhere
/// else. The most similar pairs first. Of each set, the first kMaxPlacePoints are looked at.
std::vector<PlaceMatch> matchPlaces(const PlacePoints& query, const PlacePoints& candidate);

}  // namespace roevo
