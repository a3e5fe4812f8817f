// Radius search in the pixel grid against brute force.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "core/support/random_pose.h"
#include "edges/edge_grid.h"

namespace roevo {
namespace {

using testing::uniform;

OrganizedEdges scattered(std::mt19937& random, int width, int height, int count) {
    OrganizedEdges edges;
    edges.clear();
    std::set<std::pair<long, long>> taken;  // the grid holds one point per pixel
    for (int i = 0; i < count; ++i) {
        const auto x = static_cast<float>(uniform(random, 0, width - 1)),
                   y = static_cast<float>(uniform(random, 0, height - 1));
        if (!taken.insert({std::lround(x), std::lround(y)}).second) continue;
        edges.addPoint(x, y, 1, 0, 1);
    }
    edges.finishEdge();
    computeNormals(edges, 1);
    return edges;
}

TEST(EdgeGrid, NearestIsThatOfBruteForce) {
    std::mt19937 random(41);
    EdgeGrid grid;
    int found = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        const int count = repeat % 2 == 0 ? 60 : 1500;
        const OrganizedEdges edges = scattered(random, 90, 70, count);
        grid.build(edges, 90, 70);
        std::vector<char> allowed(edges.size());
        for (auto& flag : allowed) flag = uniform(random, 0, 1) < 0.5 ? 1 : 0;
        for (int q = 0; q < 500; ++q) {
            const auto u = static_cast<float>(uniform(random, -20, 110)),
                       v = static_cast<float>(uniform(random, -20, 90));
            const auto radius = static_cast<float>(uniform(random, 0.3, EdgeGrid::kMaxRadius));
            const auto accept = [&](const EdgeGrid::Point& point) {
                return allowed[static_cast<std::size_t>(point.index)] != 0;
            };
            int expected = -1;
            float best = radius * radius;
            for (std::size_t i = 0; i < edges.size(); ++i) {
                const float dx = edges.x[i] - u, dy = edges.y[i] - v;
                if (allowed[i] == 0 || dx * dx + dy * dy >= best) continue;
                best = dx * dx + dy * dy;
                expected = static_cast<int>(i);
            }
            ASSERT_EQ(grid.nearest(u, v, radius, accept), expected);
            const auto guess = static_cast<int>(random() % edges.size());
            ASSERT_EQ(grid.nearest(u, v, radius, accept, guess), expected) << "whatever the guess";
            ASSERT_EQ(grid.nearest(u, v, radius, accept, expected), expected);
            if (expected >= 0) ++found;
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(EdgeGrid, RebuildingForgetsTheOldPoints) {
    std::mt19937 random(42);
    EdgeGrid grid;
    const OrganizedEdges old = scattered(random, 60, 50, 400);
    grid.build(old, 60, 50);
    OrganizedEdges fresh;
    fresh.clear();
    fresh.addPoint(30.2F, 20.1F, 1, 0, 1);
    fresh.finishEdge();
    computeNormals(fresh, 1);
    grid.build(fresh, 60, 50);
    const auto any = [](const EdgeGrid::Point&) { return true; };
    EXPECT_EQ(grid.nearest(30, 20, 2, any), 0);
    EXPECT_EQ(grid.nearest(10, 40, 5, any), -1);
    grid.build(fresh, 100, 100);  // another size
    EXPECT_EQ(grid.nearest(31, 21, 3, any), 0);
}

TEST(EdgeGrid, FarAwayQueriesFindNothing) {
    std::mt19937 random(43);
    EdgeGrid grid;
    const OrganizedEdges edges = scattered(random, 60, 50, 400);
    grid.build(edges, 60, 50);
    EXPECT_EQ(grid.nearest(-1e6F, -1e6F, 15, [](const EdgeGrid::Point&) { return true; }), -1);
    EXPECT_EQ(grid.nearest(30, 25, 15, [](const EdgeGrid::Point&) { return false; }), -1);
}

}  // namespace
}  // namespace roevo
