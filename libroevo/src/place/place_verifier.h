#pragma once
#include <optional>

#include "place/place_points.h"
#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo {

/// How well the points of two keyframes agree on a pose.
struct Verification {
    Pose T_candidate_query = Pose::Identity();
    int matches = 0;    ///< pairs of similar points
    int inliers = 0;    ///< of them, those that the pose explains
    double extent = 0;  ///< m; standard deviation of the inliers' positions along their second principal axis
};

/// Finds the pose that makes similar points of two keyframes meet (random samples of three pairs), without
/// any guess.
/// @param query_id, candidate_id  seed the random samples
/// @return nothing where too few agree, or all of them are on a line
[[nodiscard]] std::optional<Verification> verifyPlaces(const PlacePoints& query, int query_id,
                                                       const PlacePoints& candidate, int candidate_id,
                                                       const SensorOptions& sensor);

}  // namespace roevo
