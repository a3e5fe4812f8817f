// Matches of place points against plain loops over single bits.
#include <gtest/gtest.h>

#include <bitset>

#include "core/support/place_worlds.h"
#include "place/place_matches.h"

namespace roevo {
namespace {

using namespace testing;

int countBits(const Descriptor& a, const Descriptor& b) {
    int count = 0;
    for (std::size_t bit = 0; bit < Descriptor::kBits; ++bit)
        count += static_cast<int>(((a.words[bit / 64] ^ b.words[bit / 64]) >> (bit % 64)) & 1);
    return count;
}

std::size_t nearestOf(const PlacePoint& point, const PlacePoints& others) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < others.size(); ++k)
        if (countBits(point.descriptor, others[k].descriptor) <
            countBits(point.descriptor, others[best].descriptor))
            best = k;
    return best;
}

TEST(PlaceMatches, AreMutualNearestNeighbours) {
    for (int seed = 0; seed < 5; ++seed) {
        std::mt19937 random = seeded(seed);
        const PlacePoints query = randomPlace(120, random);
        PlacePoints candidate = seenAgain(query, Pose::Identity(), 0.001, 0.12, random);
        const PlacePoints others = randomPlace(60, random);
        candidate.insert(candidate.begin() + 40, others.begin(), others.end());
        const std::vector<PlaceMatch> matches = matchPlaces(query, candidate);
        EXPECT_GE(matches.size(), 110U);
        for (std::size_t k = 0; k < matches.size(); ++k) {
            const auto i = static_cast<std::size_t>(matches[k].query),
                       j = static_cast<std::size_t>(matches[k].candidate);
            EXPECT_EQ(nearestOf(query[i], candidate), j);
            EXPECT_EQ(nearestOf(candidate[j], query), i);
            EXPECT_EQ(countBits(query[i].descriptor, candidate[j].descriptor), matches[k].distance);
            if (k > 0) {
                EXPECT_LE(matches[k - 1].distance, matches[k].distance);
            }
        }
    }
}

TEST(PlaceMatches, ThatAreAsGoodElsewhereDoNotCount) {
    std::mt19937 random(7);
    const PlacePoints query = randomPlace(50, random);
    PlacePoints candidate = seenAgain(query, Pose::Identity(), 0, 0.05, random);
    EXPECT_EQ(matchPlaces(query, candidate).size(), 50U);
    PlacePoint twin = candidate[10];
    candidate.push_back(twin);  // at the same place
    EXPECT_EQ(matchPlaces(query, candidate).size(), 50U);
    candidate.back().x += 0.5F;  // a second one that looks the same
    EXPECT_EQ(matchPlaces(query, candidate).size(), 49U);
}

TEST(PlaceMatches, MorePointsThanAKeyframeHasAreNotLookedAt) {
    std::mt19937 random(3);
    const PlacePoints many = randomPlace(kMaxPlacePoints + 50, random);
    EXPECT_EQ(matchPlaces(many, many).size(), kMaxPlacePoints);
}

TEST(PlaceMatches, OfNothingAreNone) {
    std::mt19937 random(1);
    EXPECT_TRUE(matchPlaces({}, randomPlace(10, random)).empty());
    EXPECT_TRUE(matchPlaces(randomPlace(10, random), {}).empty());
}

}  // namespace
}  // namespace roevo
