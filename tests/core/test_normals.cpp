// Edge normals, Eqs. (5)-(7).
#include <gtest/gtest.h>

#include <cmath>

#include "edges/organized_edges.h"

namespace roevo {
namespace {

OrganizedEdges arc(float radius, int count, float step, float gradient_sign) {
    OrganizedEdges edges;
    for (int i = 0; i < count; ++i) {
        const float angle = step * static_cast<float>(i);
        const float c = std::cos(angle), s = std::sin(angle);
        edges.addPoint(100 + radius * c, 80 + radius * s, gradient_sign * c, gradient_sign * s, 10);
    }
    edges.finishEdge();
    return edges;
}

TEST(Normals, OfACircleAreRadialOnTheGradientsSide) {
    for (const float sign : {1.0F, -1.0F}) {
        for (const int span : {1, 3, 5}) {
            OrganizedEdges edges = arc(30, 100, 0.05F, sign);
            computeNormals(edges, span);
            for (std::size_t i = static_cast<std::size_t>(span); i + static_cast<std::size_t>(span) < 100;
                 ++i) {
                EXPECT_NEAR(edges.normal_x[i], edges.gradient_x[i], 1e-4);
                EXPECT_NEAR(edges.normal_y[i], edges.gradient_y[i], 1e-4);
            }
        }
    }
}

TEST(Normals, AtTheEndsTheSpanIsCut) {
    const int span = 3;
    OrganizedEdges edges = arc(30, 50, 0.05F, 1);
    computeNormals(edges, span);
    // At the first point the chord runs to the point three ahead: its normal is that of the middle of that
    // chord
    EXPECT_NEAR(std::atan2(edges.normal_y[0], edges.normal_x[0]), 0.05 * 1.5, 1e-4);
    EXPECT_NEAR(std::atan2(edges.normal_y[1], edges.normal_x[1]), 0.05 * 2, 1e-4);
    EXPECT_NEAR(std::atan2(edges.normal_y[49], edges.normal_x[49]), 0.05 * (49 - 1.5), 1e-4);
}

TEST(Normals, DoNotReachIntoTheNextEdge) {
    OrganizedEdges edges;
    for (int i = 0; i < 6; ++i) edges.addPoint(static_cast<float>(i), 10, 0, 1, 5);
    edges.finishEdge();
    for (int i = 0; i < 6; ++i) edges.addPoint(50, static_cast<float>(i), -1, 0, 5);
    edges.finishEdge();
    computeNormals(edges, 3);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(edges.normal_y[i], 1);
    for (std::size_t i = 6; i < 12; ++i) EXPECT_FLOAT_EQ(edges.normal_x[i], -1);
}

TEST(Normals, AreUnitAndNeverOppositeToTheGradient) {
    OrganizedEdges edges;
    float x = 20, y = 20;
    for (int i = 0; i < 200; ++i) {  // a crooked walk with gradients all around
        x += static_cast<float>((i * 7) % 3 - 1);
        y += static_cast<float>((i * 5) % 3 - 1);
        edges.addPoint(x, y, std::cos(0.7F * static_cast<float>(i)), std::sin(0.7F * static_cast<float>(i)),
                       5);
    }
    edges.finishEdge();
    computeNormals(edges, 2);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        EXPECT_NEAR(std::hypot(edges.normal_x[i], edges.normal_y[i]), 1, 1e-5);
        EXPECT_GE(edges.normal_x[i] * edges.gradient_x[i] + edges.normal_y[i] * edges.gradient_y[i], 0);
    }
}

TEST(Normals, OfAnEdgeThatStandsStillAreItsGradient) {
    OrganizedEdges edges;
    edges.addPoint(5, 5, 0.6F, 0.8F, 3);
    edges.finishEdge();
    computeNormals(edges, 3);
    EXPECT_FLOAT_EQ(edges.normal_x[0], 0.6F);
    EXPECT_FLOAT_EQ(edges.normal_y[0], 0.8F);
}

}  // namespace
}  // namespace roevo
