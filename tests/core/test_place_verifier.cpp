// Poses from similar points alone: exact truth, outliers, and what must not be taken for a place.
#include <gtest/gtest.h>

#include "core/support/place_views.h"
#include "core/support/place_worlds.h"
#include "place/place_verifier.h"

namespace roevo {
namespace {

using namespace testing;

/// Makes other descriptors stand at the places of some points: wrong matches.
void confuse(PlacePoints& points, double share, std::mt19937& random) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (uniform(random, 0, 1) < share) chosen.push_back(i);
    for (std::size_t k = 1; k < chosen.size(); ++k)
        std::swap(points[chosen[k - 1]].descriptor, points[chosen[k]].descriptor);
}

TEST(VerifyPlaces, FindsAnyPoseAmongManyWrongMatches) {
    for (int seed = 0; seed < 20; ++seed) {
        std::mt19937 random = seeded(seed);
        const PlacePoints candidate = randomPlace(100, random);
        const Pose T_query_candidate = randomPose(random, 0.8, 0.6);
        PlacePoints query = seenAgain(candidate, T_query_candidate, 0.005, 0.08, random);
        confuse(query, 0.7, random);
        const auto found = verifyPlaces(query, seed, candidate, 1000 + seed, SensorOptions());
        ASSERT_TRUE(found) << seed;
        EXPECT_LT(poseError(found->T_candidate_query, T_query_candidate.inverse()), 0.015) << seed;
        EXPECT_GE(found->inliers, 20);
        EXPECT_GE(found->matches, 80);
        EXPECT_GT(found->extent, 0.3);
    }
}

TEST(VerifyPlaces, IsExactWithoutNoise) {
    std::mt19937 random(1);
    const PlacePoints candidate = randomPlace(60, random);
    const Pose T_query_candidate = randomPose(random, 0.5, 0.4);
    const PlacePoints query = seenAgain(candidate, T_query_candidate, 0, 0, random);
    const auto found = verifyPlaces(query, 0, candidate, 1, SensorOptions());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->inliers, 60);
    EXPECT_LT(poseError(found->T_candidate_query, T_query_candidate.inverse()), 1e-5);
}

TEST(VerifyPlaces, SameArgumentsSameResultAndTheOtherWayRoundTheInverse) {
    std::mt19937 random(2);
    const PlacePoints candidate = randomPlace(100, random);
    PlacePoints query = seenAgain(candidate, randomPose(random, 0.5, 0.4), 0.005, 0.05, random);
    confuse(query, 0.5, random);
    const auto first = verifyPlaces(query, 3, candidate, 4, SensorOptions()),
               back = verifyPlaces(candidate, 4, query, 3, SensorOptions()),
               again = verifyPlaces(query, 3, candidate, 4, SensorOptions());
    ASSERT_TRUE(first && back && again);
    EXPECT_EQ(first->T_candidate_query.matrix(), again->T_candidate_query.matrix());
    EXPECT_LT(poseError(back->T_candidate_query, first->T_candidate_query.inverse()), 0.01);
}

TEST(VerifyPlaces, DifferentPlacesNeverAgree) {
    for (int seed = 0; seed < 200; ++seed) {
        std::mt19937 random = seeded(seed);
        const PlacePoints candidate = randomPlace(150, random);
        // Everything in it looks as there, but is somewhere else
        PlacePoints query = seenAgain(candidate, Pose::Identity(), 0, 0.05, random);
        confuse(query, 1, random);
        EXPECT_FALSE(verifyPlaces(query, seed, candidate, seed + 1, SensorOptions())) << seed;
    }
}

TEST(VerifyPlaces, NormalsMustTurnAsTheCameraDoes) {
    std::mt19937 random(6);
    const PlacePoints candidate = randomPlace(80, random);
    PlacePoints query = seenAgain(candidate, Pose::Identity(), 0.002, 0.05, random);
    ASSERT_TRUE(verifyPlaces(query, 0, candidate, 1, SensorOptions()));
    for (PlacePoint& point : query) point.normal_angle += static_cast<float>(kPi);  // bright where dark was
    EXPECT_FALSE(verifyPlaces(query, 0, candidate, 1, SensorOptions()));
}

TEST(VerifyPlaces, PointsOnALineTellNoPose) {
    std::mt19937 random(8);
    PlacePoints candidate = randomPlace(80, random);
    for (PlacePoint& point : candidate) {
        point.y = 0.2F;
        point.z = 2;
    }
    const PlacePoints query = seenAgain(candidate, Pose::Identity(), 0.003, 0.02, random);
    EXPECT_FALSE(verifyPlaces(query, 0, candidate, 1, SensorOptions()));
}

TEST(VerifyPlaces, FewOrNoPointsAreNoPlace) {
    std::mt19937 random(5);
    const PlacePoints few = randomPlace(7, random);
    EXPECT_FALSE(verifyPlaces(few, 0, few, 1, SensorOptions()));
    EXPECT_FALSE(verifyPlaces({}, 0, few, 1, SensorOptions()));
    EXPECT_FALSE(verifyPlaces({}, 0, {}, 1, SensorOptions()));
}

}  // namespace
}  // namespace roevo
