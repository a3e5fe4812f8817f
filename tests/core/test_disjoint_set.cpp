// Disjoint sets against a model that repaints every element.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "mapping/disjoint_set.h"

namespace roevo {
namespace {

/// Element -> colour; joining paints one colour over.
class NaiveSets {
  public:
    explicit NaiveSets(std::size_t size) : colour_(size) {
        for (std::size_t i = 0; i < size; ++i) colour_[i] = i;
    }
    bool unite(std::size_t a, std::size_t b) {
        const std::size_t from = colour_[a], to = colour_[b];
        if (from == to) return false;
        for (auto& colour : colour_) {
            if (colour == from) colour = to;
        }
        return true;
    }
    bool together(std::size_t a, std::size_t b) const { return colour_[a] == colour_[b]; }

  private:
    std::vector<std::size_t> colour_;
};

TEST(DisjointSet, AgreesWithANaiveModelOnRandomUnions) {
    std::mt19937 random(1);
    for (int round = 0; round < 40; ++round) {
        const std::size_t size = 1 + random() % 60;
        const std::size_t unions = random() % (2 * size);
        DisjointSet sets(size);
        NaiveSets model(size);
        std::size_t apart = size;
        for (std::size_t k = 0; k < unions; ++k) {
            const std::size_t a = random() % size, b = random() % size;
            const bool joined = model.unite(a, b);
            ASSERT_EQ(sets.unite(a, b), joined);
            apart -= joined ? 1 : 0;
            // Asked between unions too: find() shortens paths while sets still grow
            const std::size_t c = random() % size, d = random() % size;
            ASSERT_EQ(sets.find(c) == sets.find(d), model.together(c, d));
        }
        std::set<std::size_t> representatives;
        for (std::size_t a = 0; a < size; ++a) {
            representatives.insert(sets.find(a));
            for (std::size_t b = 0; b < size; ++b) {
                ASSERT_EQ(sets.find(a) == sets.find(b), model.together(a, b)) << a << ' ' << b;
            }
        }
        EXPECT_EQ(representatives.size(), apart);
    }
}

TEST(DisjointSet, TheRepresentativeIsAMemberAndStandsForItself) {
    DisjointSet sets(50);
    NaiveSets model(50);
    std::mt19937 random(2);
    for (int k = 0; k < 35; ++k) {
        const std::size_t a = random() % 50, b = random() % 50;
        sets.unite(a, b);
        model.unite(a, b);
    }
    for (std::size_t a = 0; a < 50; ++a) {
        const std::size_t top = sets.find(a);
        ASSERT_LT(top, 50U);
        EXPECT_TRUE(model.together(a, top));
        EXPECT_EQ(sets.find(top), top);
        EXPECT_EQ(sets.find(a), top) << "asking again changes nothing";
    }
}

TEST(DisjointSet, TheLargerSetKeepsItsRepresentative) {
    DisjointSet sets(10);
    for (std::size_t k = 1; k < 6; ++k) sets.unite(0, k);
    const std::size_t large = sets.find(0);
    sets.unite(7, 8);
    sets.unite(8, 9);
    ASSERT_TRUE(sets.unite(9, 3));
    for (std::size_t k : {0, 1, 2, 3, 4, 5, 7, 8, 9}) EXPECT_EQ(sets.find(k), large);
    EXPECT_EQ(sets.find(6), 6U);
}

TEST(DisjointSet, ALongChainIsFollowedToItsEnd) {
    constexpr std::size_t kSize = 200000;
    DisjointSet sets(kSize);
    for (std::size_t k = 1; k < kSize; ++k) ASSERT_TRUE(sets.unite(k - 1, k));
    EXPECT_EQ(sets.find(0), sets.find(kSize - 1));
    EXPECT_FALSE(sets.unite(0, kSize - 1));
}

}  // namespace
}  // namespace roevo
