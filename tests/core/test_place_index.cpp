// The index of places against brute force, its order, and its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/support/place_worlds.h"
#include "place/place_index.h"
#include "stopwatch.h"

namespace roevo {
namespace {

using namespace testing;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kInstrumented = true;
#else
constexpr bool kInstrumented = false;
#endif

/// Brute force: the keyframe with most points that differ from one of the query's by few bits.
int mostSimilar(const std::vector<PlacePoints>& keyframes, const PlacePoints& query) {
    constexpr int kAlike = 64;
    int best = 0, most = -1;
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
        const auto alike =
            static_cast<int>(std::count_if(query.begin(), query.end(), [&](const PlacePoint& point) {
                return std::any_of(keyframes[k].begin(), keyframes[k].end(), [&](const PlacePoint& other) {
                    return hammingDistance(point.descriptor, other.descriptor) <= kAlike;
                });
            }));
        if (alike > most) {
            most = alike;
            best = static_cast<int>(k);
        }
    }
    return best;
}

bool any(int /*id*/) {
    return true;
}

std::vector<int> idsOf(const std::vector<PlaceCandidate>& candidates) {
    std::vector<int> ids;
    for (const PlaceCandidate& candidate : candidates) ids.push_back(candidate.id);
    return ids;
}

TEST(BucketLists, HoldWhatWasAppended) {
    std::mt19937 random(5);
    BucketLists lists;
    lists.reset(50);
    std::vector<std::vector<std::uint32_t>> oracle(50);
    for (std::uint32_t k = 0; k < 20000; ++k) {
        const std::size_t list = random() % 50 * (random() % 50) / 50;  // some are long
        lists.append(list, k);
        oracle[list].push_back(k);
    }
    for (std::size_t list = 0; list < oracle.size(); ++list)
        EXPECT_EQ(std::vector<std::uint32_t>(lists.begin(list), lists.end(list)), oracle[list]);
    EXPECT_LT(lists.bytes(), 6 * 20000 * sizeof(std::uint32_t));
}

TEST(PlaceIndex, FindsWhatBruteForceFinds) {
    std::mt19937 random(11);
    std::vector<PlacePoints> keyframes;
    PlaceIndex index;
    for (int k = 0; k < 40; ++k) {
        keyframes.push_back(randomPlace(100, random));
        index.insert(k, keyframes.back());
    }
    for (int k = 0; k < 40; ++k) {
        // A third of the points is seen again, with every eighth bit wrong
        PlacePoints query =
            seenAgain(keyframes[static_cast<std::size_t>(k)], Pose::Identity(), 0, 0.12, random);
        query.resize(33);
        const PlacePoints others = randomPlace(67, random);
        query.insert(query.end(), others.begin(), others.end());
        const std::vector<PlaceCandidate> found = index.query(query, 3, any);
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(found.front().id, k);
        EXPECT_EQ(found.front().id, mostSimilar(keyframes, query));
    }
}

TEST(PlaceIndex, OrderOfInsertionDoesNotMatterAndEqualScoresGoById) {
    std::mt19937 random(2);
    std::vector<PlacePoints> keyframes;
    for (int k = 0; k < 12; ++k) keyframes.push_back(randomPlace(60, random));
    keyframes[9] = keyframes[4];
    std::vector<int> order(keyframes.size());
    std::iota(order.begin(), order.end(), 0);
    const PlacePoints query = seenAgain(keyframes[4], Pose::Identity(), 0, 0.05, random);
    std::vector<PlaceCandidate> first;
    for (int k = 0; k < 5; ++k) {
        PlaceIndex index;
        for (const int id : order) index.insert(id, keyframes[static_cast<std::size_t>(id)]);
        const std::vector<PlaceCandidate> other = index.query(query, 12, any);
        if (k == 0) first = other;
        EXPECT_EQ(idsOf(other), idsOf(first));
        ASSERT_GE(other.size(), 2U);
        EXPECT_EQ(other[0].id, 4);
        EXPECT_EQ(other[1].id, 9);
        EXPECT_EQ(other[0].score, other[1].score);
        std::shuffle(order.begin(), order.end(), random);
    }
}

TEST(PlaceIndex, ExcludedOnesAreNoCandidatesAndNoMoreComeThanWereAskedFor) {
    std::mt19937 random(3);
    PlaceIndex index;
    EXPECT_TRUE(index.query(randomPlace(10, random), 5, any).empty()) << "nothing was inserted yet";
    const PlacePoints points = randomPlace(50, random);
    for (int id : {7, 3, 100, 42}) index.insert(id, points);
    const auto others = index.query(points, 10, [](int id) { return id != 42 && id != 3; });
    EXPECT_EQ(idsOf(others), (std::vector<int>{7, 100}));
    EXPECT_EQ(idsOf(index.query(points, 1, any)), std::vector<int>{3});
    EXPECT_TRUE(index.query({}, 10, any).empty());
    index.insert(5, {});
    EXPECT_EQ(index.size(), 5U);
}

/// Least of some times of a query, ms.
double queryTime(PlaceIndex& index, const PlacePoints& query) {
    double least = 1e9;
    for (int k = 0; k < 9; ++k) {
        const Stopwatch watch;
        (void)index.query(query, 10, any);
        least = std::min(least, watch.milliseconds());
    }
    return least;
}

/// Descriptors only, which is all that the index looks at.
PlacePoints randomLooks(std::size_t count, std::mt19937& random) {
    PlacePoints points(count);
    for (PlacePoint& point : points) point.descriptor = randomDescriptor(random);
    return points;
}

/// Places made of the same few words, as rooms full of similar things are: buckets of very different sizes.
PlacePoints wordy(const PlacePoints& words, std::mt19937& random) {
    PlacePoints points(kMaxPlacePoints);
    for (PlacePoint& point : points) {
        // The first words are much more frequent
        const std::size_t range = 1 + random() % words.size();
        point = words[random() % range];
        for (int flips = 0; flips < 10; ++flips) {
            const std::size_t bit = random() % Descriptor::kBits;
            point.descriptor.words[bit / 64] ^= std::uint64_t{1} << (bit % 64);
        }
    }
    return points;
}

TEST(PlaceIndex, AThousandKeyframesTakeFiveMillisecondsAndTenThousandThirty) {
    if (kInstrumented) GTEST_SKIP() << "times of instrumented code say nothing";
    for (const bool structured : {false, true}) {
        std::mt19937 random(9);
        const PlacePoints words = randomLooks(3000, random);
        PlaceIndex index;
        PlacePoints points;
        for (int k = 0; k < 10000; ++k) {
            points = structured ? wordy(words, random) : randomLooks(kMaxPlacePoints, random);
            index.insert(k, points);
            if (k == 999) {
                const double ms = queryTime(index, points);
                RecordProperty(structured ? "structured_1000_ms" : "random_1000_ms", std::to_string(ms));
                EXPECT_LE(ms, 5);
            }
        }
        const double ms = queryTime(index, points);
        RecordProperty(structured ? "structured_10000_ms" : "random_10000_ms", std::to_string(ms));
        EXPECT_LE(ms, 30);
        EXPECT_LE(index.bytes() / index.size(), 60'000U);
    }
}

TEST(PlaceIndex, KeyframesAllAlikeTakeNoLonger) {
    if (kInstrumented) GTEST_SKIP() << "times of instrumented code say nothing";
    std::mt19937 random(4);
    const PlacePoints points = randomPlace(400, random);
    PlaceIndex index;
    for (int k = 0; k < 1000; ++k) index.insert(k, points);
    EXPECT_LE(queryTime(index, points), 5);
}

}  // namespace
}  // namespace roevo
