#pragma once
#include <optional>
#include <vector>

#include "place/place_matches.h"
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
/// any guess. Keeps its buffers; its result depends on nothing but the arguments.
class PlaceVerifier {
  public:
    explicit PlaceVerifier(const SensorOptions& sensor) : sensor_(sensor) {}

    /// @param query_id, candidate_id  seed the random samples
    /// @return nothing where too few agree, or all of them are on a line
    [[nodiscard]] std::optional<Verification> verify(const PlacePoints& query, int query_id,
                                                     const PlacePoints& candidate, int candidate_id);

  private:
    struct Pair {
        Eigen::Vector3d query, candidate;  ///< positions in their own frames, m
        double turn;                       ///< of the normal from query to candidate in the image, rad
        double information;                ///< 1/m^2, of their distance
    };
    void collect(const PlacePoints& query, const PlacePoints& candidate);
    bool explains(const Pose& T_candidate_query, double roll, const Pair& pair) const;
    int countInliers(const Pose& T_candidate_query) const;
    bool mayBeOfOnePose(const Pair& a, const Pair& b) const;
    Pose sample(std::uint32_t seed, int& best_inliers) const;
    Pose refine(const Pose& T_candidate_query) const;
    Verification describe(const Pose& T_candidate_query) const;

    SensorOptions sensor_;
    std::vector<Pair> pairs_;  ///< the most similar ones first
};

}  // namespace roevo
