#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "evaluation/association.h"

namespace roevo {
namespace {

TEST(Association, TakesTheClosestPairsFirst) {
    // The first colour image would like depth 0.018, but that one is closer to the second.
    const auto matches = associateStamps({0.000, 0.019}, {0.018, 0.038}, 0.02);
    ASSERT_EQ(matches.size(), 1u);
    EXPECT_EQ(matches[0].first, 1u);
    EXPECT_EQ(matches[0].second, 0u);
}

TEST(Association, RespectsTheLimit) {
    EXPECT_EQ(associateStamps({1.0}, {1.0199}, 0.02).size(), 1u);
    EXPECT_EQ(associateStamps({1.0}, {1.0201}, 0.02).size(), 0u);
    EXPECT_TRUE(associateStamps({}, {1.0}, 0.02).empty());
}

TEST(Association, IsOneToOneAndGreedyOnRandomLists) {
    std::mt19937 rng(7);
    for (int trial = 0; trial < 200; trial++) {
        std::uniform_real_distribution<double> time(0, 2);
        std::vector<double> first(60), second(50);
        for (auto* list : {&first, &second}) {
            for (double& t : *list) t = time(rng);
            std::sort(list->begin(), list->end());
        }
        const double limit = 0.02;
        const auto matches = associateStamps(first, second, limit);
        std::set<std::size_t> first_used, second_used;
        std::vector<double> best_first(first.size(), INFINITY), best_second(second.size(), INFINITY);
        for (const StampMatch& m : matches) {
            EXPECT_TRUE(first_used.insert(m.first).second);
            EXPECT_TRUE(second_used.insert(m.second).second);
            const double difference = std::abs(first[m.first] - second[m.second]);
            EXPECT_LE(difference, limit + 1e-12);
            best_first[m.first] = best_second[m.second] = difference;
        }
        // Greedy: any pair that was passed over has a partner matched at least as closely.
        for (std::size_t i = 0; i < first.size(); i++)
            for (std::size_t j = 0; j < second.size(); j++) {
                const double difference = std::abs(first[i] - second[j]);
                if (difference > limit - 1e-12) continue;
                EXPECT_LE(std::min(best_first[i], best_second[j]), difference);
            }
        EXPECT_TRUE(
            std::is_sorted(matches.begin(), matches.end(),
                           [](const StampMatch& a, const StampMatch& b) { return a.first < b.first; }));
    }
}

}  // namespace
}  // namespace roevo
