// Association of edges: what agrees, what is voted down, and what share of the reference it makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "roevo/types.h"
#include "tracking/edge_association.h"

namespace roevo {
namespace {

constexpr int kWidth = 320, kHeight = 240, kSpan = 4;
constexpr double kRadius = 6;
const PinholeCamera kFlatCamera{kWidth, kHeight, 260, 260, 160, 120, {}};

/// Straight edge of `count` points 1 px apart in x about (u, v), rising by `degrees`; `side` +1: brighter
/// below.
void addLine(OrganizedEdges& edges, double u, double v, int count, double degrees = 0, int side = 1) {
    const double slope = std::tan(degrees * kDegree), length = std::hypot(1, slope);
    for (int i = 0; i < count; ++i) {
        const double x = i - (count - 1) / 2.0;
        edges.addPoint(static_cast<float>(u + x), static_cast<float>(v + slope * x),
                       static_cast<float>(-side * slope / length), static_cast<float>(side / length), 20);
    }
    edges.finishEdge();
}

OrganizedEdges line(double u, double v, int count, double degrees = 0, int side = 1) {
    OrganizedEdges edges;
    addLine(edges, u, v, count, degrees, side);
    return edges;
}

/// Associates `reference`, shifted by `shift` and with its normals turned, with `current`.
EdgeMatches match(OrganizedEdges reference, OrganizedEdges current,
                  const FineOptions& options = FineOptions(), const Eigen::Vector2f& shift = {0, 0},
                  double turn_deg = 0) {
    computeNormals(reference, kSpan);
    computeNormals(current, kSpan);
    EdgeGrid grid;
    grid.build(current, kWidth, kHeight);
    ProjectedPoints3 projected;
    for (const float x : reference.x) projected.u.push_back(x + shift.x());
    for (const float y : reference.y) projected.v.push_back(y + shift.y());
    const Pose turn(Eigen::AngleAxisd(turn_deg * kDegree, Eigen::Vector3d::UnitZ()));
    EdgeAssociator associator(kFlatCamera, options, kSpan);
    EdgeMatches matches;
    associator.associate(reference, projected, turn, current, grid, kRadius, matches);
    EXPECT_EQ(matches.reference.size(), matches.current.size());
    return matches;
}

/// Pairs with each of the current edges.
std::map<int, int> countByEdge(const EdgeMatches& matches, const OrganizedEdges& current) {
    std::map<int, int> count;
    for (const auto i : matches.current) ++count[current.edge_of[static_cast<std::size_t>(i)]];
    return count;
}

TEST(EdgeAssociation, StraightEdgesShiftedByOnePixelAreAllAssociated) {
    OrganizedEdges edges = line(100, 60, 80);
    addLine(edges, 200, 150, 101, 30);
    addLine(edges, 80, 180, 50, -40, -1);
    const EdgeMatches matches = match(edges, edges, FineOptions(), {0, 1});
    ASSERT_EQ(matches.size(), edges.size());
    EXPECT_EQ(matches.matchedRatio(), 1);
    EXPECT_EQ(matches.visible_points, static_cast<int>(edges.size()));
    for (std::size_t pair = 0; pair < matches.size(); ++pair) {
        const auto i = static_cast<std::size_t>(matches.reference[pair]),
                   j = static_cast<std::size_t>(matches.current[pair]);
        EXPECT_EQ(matches.reference[pair], static_cast<int>(pair)) << "in the reference's order";
        EXPECT_EQ(edges.edge_of[i], edges.edge_of[j]);
        EXPECT_LE(std::hypot(edges.x[i] - edges.x[j], edges.y[i] + 1 - edges.y[j]), 1.0001);
    }
}

TEST(EdgeAssociation, BeyondTheRadiusNothingIsAssociated) {
    const OrganizedEdges edges = line(100, 60, 80);
    EXPECT_EQ(match(edges, edges, FineOptions(), {0, 5.9F}).size(), 80U);
    EXPECT_EQ(match(edges, edges, FineOptions(), {0, 6.1F}).size(), 0U);
}

TEST(EdgeAssociation, AnEdgeOfOppositeGradientIsAnotherEdge) {
    const OrganizedEdges reference = line(100, 60, 80);
    const EdgeMatches matches = match(reference, line(100, 61, 80, 0, -1));
    EXPECT_EQ(matches.size(), 0U);
    EXPECT_EQ(matches.visible_points, 80);
    EXPECT_EQ(matches.matchedRatio(), 0);
    // The farther one of the right side is taken instead
    OrganizedEdges both = line(100, 61, 80, 0, -1);
    addLine(both, 100, 64, 80);
    EXPECT_EQ(countByEdge(match(reference, both), both), (std::map<int, int>{{1, 80}}));
}

TEST(EdgeAssociation, TheTurnCarriesTheReferencesNormals) {
    // Upside down: the points of a level edge change their order, and its gradient points up
    OrganizedEdges turned = line(100, 60, 80);
    std::reverse(turned.x.begin(), turned.x.end());
    const OrganizedEdges current = line(100, 61, 80, 0, -1);
    EXPECT_EQ(match(turned, current, FineOptions(), {0, 0}, 180).size(), 80U);
    EXPECT_EQ(match(turned, current).size(), 0U);
}

TEST(EdgeAssociation, NormalsMustAgreeWithinTheAngle) {
    const OrganizedEdges reference = line(100, 60, 41), current = line(100, 60, 41, 8);
    FineOptions options;
    options.normal_angle_deg = 5;
    EXPECT_EQ(match(reference, current, options).size(), 0U);
    options.normal_angle_deg = 10;
    EXPECT_EQ(match(reference, current, options).size(), 41U);
    options.normal_angle_deg = 5;
    EXPECT_EQ(match(reference, line(100, 60, 41, 4), options).size(), 41U);
}

TEST(EdgeAssociation, OneEdgeMayFallIntoFragments) {
    const OrganizedEdges reference = line(100, 60, 90);
    OrganizedEdges fragments;
    for (const double u : {70.0, 100.0, 130.0}) addLine(fragments, u, 61, 30);
    const EdgeMatches matches = match(reference, fragments);
    EXPECT_EQ(countByEdge(matches, fragments), (std::map<int, int>{{0, 30}, {1, 30}, {2, 30}}));
    EXPECT_EQ(matches.shownShare(), 1);
    EXPECT_EQ(matches.matchedRatio(), 1);
}

TEST(EdgeAssociation, ACrossingEdgeIsVotedDown) {
    // The reference's edge is found again but for a gap of 17 points, where another edge crosses at 4 degrees
    const OrganizedEdges reference = line(100, 100, 101);
    const auto withCrossing = [](int length) {
        OrganizedEdges current;
        addLine(current, 70.5, 100.2, 42);   // x = 50 ... 91
        addLine(current, 129.5, 100.2, 42);  // x = 109 ... 150
        addLine(current, 100, 100, length, 4);
        return current;
    };
    const OrganizedEdges current = withCrossing(101);
    const EdgeMatches matches = match(reference, current);
    EXPECT_EQ(countByEdge(matches, current), (std::map<int, int>{{0, 42}, {1, 42}}));
    EXPECT_EQ(matches.matchedRatio(), 1) << "an edge counts whole, however much of it was found";
    // The same 17 votes are most of a short edge
    const OrganizedEdges shorter = withCrossing(21);
    EXPECT_EQ(countByEdge(match(reference, shorter), shorter)[2], 17);
    FineOptions strict;
    strict.min_votes = 18;
    EXPECT_EQ(countByEdge(match(reference, shorter, strict), shorter)[2], 0);
}

TEST(EdgeAssociation, AStrideSpreadsOverTheEdgesAndKeepsTheRatio) {
    OrganizedEdges reference, current;
    for (int e = 0; e < 10; ++e) {
        addLine(reference, 150, 20 + 20 * e, 53);
        if (e % 5 < 3) addLine(current, 150, 21 + 20 * e, 53);
    }
    FineOptions options;
    EXPECT_NEAR(match(reference, current, options).matchedRatio(), 0.6, 1e-12);
    options.max_points = 60;
    const EdgeMatches matches = match(reference, current, options);
    EXPECT_LE(matches.visible_points, options.max_points);
    EXPECT_GT(matches.visible_points, options.max_points / 2);
    EXPECT_NEAR(matches.matchedRatio(), 0.6, 0.02) << "edges counted to a point";
    const auto count = countByEdge(matches, current);
    ASSERT_EQ(count.size(), 6U);
    for (const auto& [edge, points] : count) EXPECT_NEAR(points, 53.0 / 9, 1) << edge;
}

TEST(EdgeAssociation, OnlyPointsInsideTheImageCount) {
    const OrganizedEdges edges = line(100, 60, 80);
    const EdgeMatches half = match(edges, edges, FineOptions(), {-96.5F, 0});  // x = -36 ... 43
    EXPECT_EQ(half.visible_points, 40) << "x = 4 ... 43; four pixels of border";
    EXPECT_EQ(half.visibleShare(), 0.5);
    EXPECT_EQ(half.shownShare(), 0) << "the edge itself is elsewhere";
    EXPECT_EQ(match(edges, edges).shownShare(), 1);
    EXPECT_EQ(match(edges, edges, FineOptions(), {0, -100}).visible_points, 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(match(edges, edges, FineOptions(), {nan, nan}).visible_points, 0);
    EXPECT_EQ(match(edges, edges, FineOptions(), {-1e6F, -1e6F}).matchedRatio(), 0);
}

TEST(EdgeAssociation, NothingIsAssociatedWithNothing) {
    const OrganizedEdges edges = line(100, 60, 80);
    EXPECT_EQ(match(edges, OrganizedEdges()).size(), 0U);
    EXPECT_EQ(match(edges, OrganizedEdges()).matchedRatio(), 0);
    EXPECT_EQ(match(OrganizedEdges(), edges).size(), 0U);
    EXPECT_EQ(match(OrganizedEdges(), edges).matchedRatio(), 0);
    EXPECT_EQ(match(OrganizedEdges(), OrganizedEdges()).size(), 0U);
}

}  // namespace
}  // namespace roevo
