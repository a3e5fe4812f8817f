// Radius search among the points of edges against brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/support/random_pose.h"
#include "edges/edge_grid.h"

namespace roevo {
namespace {

using testing::uniform;

OrganizedEdges scattered(std::mt19937& random, int width, int height, int count) {
    OrganizedEdges edges;
    edges.clear();
    for (int i = 0; i < count; ++i) {
        const double angle = uniform(random, 0, 2 * M_PI);
        edges.addPoint(static_cast<float>(uniform(random, 0, width - 1)),
                       static_cast<float>(uniform(random, 0, height - 1)),
                       static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 1);
    }
    edges.finishEdge();
    edges.normal_x = edges.gradient_x;
    edges.normal_y = edges.gradient_y;
    return edges;
}

int nearestOf(const EdgeGrid& grid, float u, float v, double radius, double min_cosine, double angle = 0) {
    const EdgeQueries query{
        {u}, {v}, {static_cast<float>(std::cos(angle))}, {static_cast<float>(std::sin(angle))}};
    std::int32_t found = -2;
    grid.nearest(query, 1, radius, min_cosine, &found);
    return found;
}

TEST(EdgeGrid, NearestIsThatOfBruteForce) {
    std::mt19937 random(41);
    EdgeGrid grid;
    int found = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        const OrganizedEdges edges = scattered(random, 90, 70, repeat % 2 == 0 ? 60 : 1500);
        grid.build(edges, 90, 70);
        for (int q = 0; q < 500; ++q) {
            const auto u = static_cast<float>(uniform(random, -20, 110)),
                       v = static_cast<float>(uniform(random, -20, 90));
            const auto radius = static_cast<float>(uniform(random, 0.3, 30));
            const double angle = uniform(random, 0, 2 * M_PI), min_cosine = uniform(random, -1, 1);
            const auto agrees = [&](std::size_t i) {
                return edges.normal_x[i] * static_cast<float>(std::cos(angle)) +
                           edges.normal_y[i] * static_cast<float>(std::sin(angle)) >=
                       static_cast<float>(min_cosine);
            };
            int expected = -1;
            float best = radius * radius;
            for (std::size_t i = 0; i < edges.size(); ++i) {
                const float dx = edges.x[i] - u, dy = edges.y[i] - v;
                if (dx * dx + dy * dy >= best || !agrees(i)) continue;
                best = dx * dx + dy * dy;
                expected = static_cast<int>(i);
            }
            ASSERT_EQ(nearestOf(grid, u, v, radius, min_cosine, angle), expected);
            ASSERT_EQ(grid.any(u, v, radius, agrees), expected >= 0);
            found += expected >= 0 ? 1 : 0;
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(EdgeGrid, RebuildingForgetsTheOldPoints) {
    std::mt19937 random(42);
    EdgeGrid grid;
    grid.build(scattered(random, 60, 50, 400), 60, 50);
    OrganizedEdges fresh = scattered(random, 1, 1, 1);
    fresh.x = {30.2F};
    fresh.y = {20.1F};
    grid.build(fresh, 60, 50);
    EXPECT_EQ(nearestOf(grid, 30, 20, 2, -1), 0);
    EXPECT_EQ(nearestOf(grid, 10, 40, 5, -1), -1);
    grid.build(fresh, 100, 100);  // another size
    EXPECT_EQ(nearestOf(grid, 31, 21, 3, -1), 0);
    fresh.clear();
    grid.build(fresh, 100, 100);
    EXPECT_EQ(nearestOf(grid, 31, 21, 3, -1), -1);
}

TEST(EdgeGrid, FarAwayQueriesFindNothing) {
    std::mt19937 random(43);
    EdgeGrid grid;
    grid.build(scattered(random, 60, 50, 400), 60, 50);
    EXPECT_EQ(nearestOf(grid, -1e6F, -1e6F, 15, -1), -1);
    EXPECT_EQ(nearestOf(grid, 30, 1e6F, 15, -1), -1);
    EXPECT_FALSE(grid.any(30, 25, 15, [](std::size_t) { return false; }));
}

}  // namespace
}  // namespace roevo
