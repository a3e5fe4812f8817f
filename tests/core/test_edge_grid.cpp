// Radius search among the points of edges against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/support/random_pose.h"
#include "edges/edge_grid.h"
#include "kernels/kernels.h"

namespace roevo {
namespace {

using testing::uniform;

OrganizedEdges scattered(std::mt19937& random, int width, int height, int count) {
    OrganizedEdges edges;
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

/// The kernel of each instruction set.
TEST(EdgeGrid, NearestPointsAreThoseOfAllPoints) {
    constexpr int kColumns = 12, kRows = 5, kPoints = 300;
    constexpr float kRadius = 5, kMinCosine = 0.5F;
    std::mt19937 random(8);
    std::uniform_real_distribution<float> column(0, kColumns * kernels::kCellWidth - 0.01F),
        row(0, kRows * kernels::kCellHeight - 0.01F), angle(0, 6.28F);
    struct Point {
        float x, y, angle;
        int cell() const {
            return static_cast<int>(y) / kernels::kCellHeight * kColumns +
                   static_cast<int>(x) / kernels::kCellWidth;
        }
    };
    std::vector<Point> points;
    for (int i = 0; i < kPoints; ++i) points.push_back({column(random), row(random), angle(random)});
    points.push_back(points.front());  // as near: the first one counts
    std::stable_sort(points.begin(), points.end(),
                     [](const Point& a, const Point& b) { return a.cell() < b.cell(); });
    std::vector<float> x, y, nx, ny;
    std::vector<std::int32_t> index, first(kColumns * kRows + 1, 0);
    for (const Point& point : points) {
        index.push_back(1000 + static_cast<int>(index.size()));
        x.push_back(point.x);
        y.push_back(point.y);
        nx.push_back(std::cos(point.angle));
        ny.push_back(std::sin(point.angle));
        for (std::size_t cell = static_cast<std::size_t>(point.cell()) + 1; cell < first.size(); ++cell)
            ++first[cell];
    }
    for (auto* values : {&x, &y, &nx, &ny}) values->resize(points.size() + kernels::kGridPadding, 1e9F);
    std::vector<float> u, v, qx, qy;
    for (int i = 0; i < 500; ++i) {
        u.push_back(2 * column(random) - 20);  // outside, too
        v.push_back(2 * row(random) - 20);
        const float a = angle(random);
        qx.push_back(std::cos(a));
        qy.push_back(std::sin(a));
    }
    u[0] = -1e6F;
    v[1] = 1e6F;
    int with = 0;
    for (const auto* table : {&kernels::baseline(), kernels::avx2()}) {
        if (table == nullptr) continue;
        std::vector<std::int32_t> found(u.size());
        table->nearestPoints(
            {x.data(), y.data(), nx.data(), ny.data(), index.data(), first.data(), kColumns, kRows}, u.data(),
            v.data(), qx.data(), qy.data(), u.size(), kRadius, kMinCosine, found.data());
        for (std::size_t q = 0; q < u.size(); ++q) {
            std::int32_t expected = -1;
            float least = kRadius * kRadius;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const float du = x[i] - u[q], dv = y[i] - v[q], squared = du * du + dv * dv;
                if (squared >= least || nx[i] * qx[q] + ny[i] * qy[q] < kMinCosine) continue;
                least = squared;
                expected = index[i];
            }
            ASSERT_EQ(found[q], expected) << table->name << ' ' << q;
            with += expected >= 0 ? 1 : 0;
        }
    }
    EXPECT_GT(with, 100);
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
    fresh = OrganizedEdges();
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
