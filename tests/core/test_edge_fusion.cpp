// Edges of several keyframes fused into one: fitting, stitching, and what does not belong together.
#include <gtest/gtest.h>

#include <set>

#include "core/support/mapping_world.h"

namespace roevo {
namespace {

using namespace testing;

constexpr double kNoiseFree = 1e-6;  ///< m: the points are single precision

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

/// Every list has its length, observations refer to points that there are, and no point is observed twice.
void expectSound(const FusedEdges& edges, const std::vector<WindowKeyframe>& window) {
    const std::size_t count = static_cast<std::size_t>(edges.numEdges());
    ASSERT_EQ(edges.clusters.size(), count);
    ASSERT_EQ(edges.views.size(), count);
    ASSERT_EQ(edges.verdicts.size(), count);
    ASSERT_EQ(at(edges.begin.back()), edges.points.size());
    ASSERT_EQ(edges.observation_begin.size(), edges.points.size() + 1);
    ASSERT_EQ(at(edges.observation_begin.back()), edges.observations.size());
    std::set<std::pair<int, int>> observed;
    for (std::size_t e = 0; e < count; ++e) {
        ASSERT_LT(edges.begin[e], edges.begin[e + 1]);
        std::set<int> slots;
        for (std::size_t p = at(edges.begin[e]); p < at(edges.begin[e + 1]); ++p) {
            ASSERT_LT(edges.observation_begin[p], edges.observation_begin[p + 1])
                << "a point that nothing shows";
            for (std::size_t k = at(edges.observation_begin[p]); k < at(edges.observation_begin[p + 1]);
                 ++k) {
                const Observation& seen = edges.observations[k];
                ASSERT_GE(seen.slot, 0);
                ASSERT_LT(at(seen.slot), window.size());
                ASSERT_GE(seen.point, 0);
                ASSERT_LT(at(seen.point), window[at(seen.slot)].keyframe->size());
                ASSERT_TRUE(observed.emplace(seen.slot, seen.point).second)
                    << "point " << seen.point << " of keyframe " << seen.slot << " twice";
                slots.insert(seen.slot);
            }
        }
        EXPECT_EQ(edges.views[e], static_cast<int>(slots.size()));
        EXPECT_EQ(edges.verdicts[e] == EdgeVerdict::kTrue, slots.size() > 1);
    }
}

/// Along the edge no step is longer than `bound` spacings, and none goes back.
void expectInOrder(const FusedEdges& edges, int edge, double spacing, double bound) {
    for (std::size_t p = at(edges.begin[at(edge)]) + 1; p < at(edges.begin[at(edge) + 1]); ++p) {
        const Eigen::Vector3d step = edges.points[p] - edges.points[p - 1];
        ASSERT_LE(step.norm(), bound * spacing) << "edge " << edge << " point " << p;
        if (p - 1 > at(edges.begin[at(edge)])) {
            ASSERT_GT(step.dot(edges.points[p - 1] - edges.points[p - 2]), 0)
                << "edge " << edge << " point " << p;
        }
    }
}

double lengthOf(const FusedEdges& edges, int edge) {
    double length = 0;
    for (std::size_t p = at(edges.begin[at(edge)]) + 1; p < at(edges.begin[at(edge) + 1]); ++p)
        length += (edges.points[p] - edges.points[p - 1]).norm();
    return length;
}

std::size_t observationsOf(const FusedEdges& edges, int edge) {
    return at(edges.observation_begin[at(edges.begin[at(edge) + 1])] -
              edges.observation_begin[at(edges.begin[at(edge)])]);
}

class EdgeFusion : public ::testing::Test {
  protected:
    /// Fuses what keyframes on the path see of the curves, at the true poses, all edges in cluster 0 unless
    /// `by_curve`.
    void fuseViews(const std::vector<std::vector<Sighting>>& views, bool by_curve = true) {
        made_.clear();
        for (std::size_t k = 0; k < views.size(); ++k) {
            const int id = static_cast<int>(k);
            made_.push_back(makeKeyframe(id, placeOnPath(id), curves_, views[k]));
        }
        window_ = windowOf(made_);
        auto clusters = clustersByCurve(made_);
        if (!by_curve) {
            for (auto& of_edges : clusters) std::fill(of_edges.begin(), of_edges.end(), 0);
        }
        edges_ = fuse(window_, clusters);
        expectSound(edges_, window_);
    }
    /// Two lines 10 cm apart at one depth, wrongly in one cluster, must come out as two edges.
    void expectParallelLinesApart(double depth) {
        const double half = 0.3 * depth;
        curves_ = {segment({-half, 0, depth}, {half, 0, depth}),
                   segment({-half, 0.1, depth}, {half, 0.1, depth})};
        fuseViews({{{0}, {1}}, {{0, 0, -1, 0.5}, {1, 0, -1, 0.5}}, {{0}, {1}}}, false);
        ASSERT_EQ(edges_.numEdges(), 2);
        for (int e = 0; e < 2; ++e) {
            EXPECT_EQ(edges_.views[at(e)], 3);
            const Eigen::Vector3d& start = edges_.points[at(edges_.begin[at(e)])];
            const Curve& curve = curves_[std::abs(start.y()) < 0.05 ? 0 : 1];
            for (std::size_t p = at(edges_.begin[at(e)]); p < at(edges_.begin[at(e) + 1]); ++p) {
                ASSERT_LT(distanceTo(curve, edges_.points[p]), kNoiseFree);
                for (std::size_t k = at(edges_.observation_begin[p]); k < at(edges_.observation_begin[p + 1]);
                     ++k) {
                    const Observation& seen = edges_.observations[k];
                    const WindowKeyframe& view = window_[at(seen.slot)];
                    ASSERT_LT(
                        distanceTo(curve, view.T_world_camera * view.keyframe->points.at(at(seen.point))),
                        1e-5);
                }
            }
        }
    }
    std::size_t keyframePoints() const {
        std::size_t count = 0;
        for (const TestKeyframe& made : made_) count += made.keyframe.size();
        return count;
    }

    std::vector<Curve> curves_ = room();
    std::vector<TestKeyframe> made_;
    std::vector<WindowKeyframe> window_;
    FusedEdges edges_;
};

TEST_F(EdgeFusion, EveryCurveIsOneEdgeOnTheTruth) {
    const int whole = static_cast<int>(curves_.size());
    fuseViews({seeAll(curves_), seeAll(curves_, 0.3), seeAll(curves_, 0.6), seeAll(curves_, 0.9)});
    ASSERT_EQ(edges_.numEdges(), whole);
    for (int e = 0; e < whole; ++e) {
        const Curve& curve = curves_[at(edges_.clusters[at(e)])];
        EXPECT_EQ(edges_.views[at(e)], 4);
        EXPECT_EQ(edges_.verdicts[at(e)], EdgeVerdict::kTrue);
        for (std::size_t p = at(edges_.begin[at(e)]); p < at(edges_.begin[at(e) + 1]); ++p)
            ASSERT_LT(distanceTo(curve, edges_.points[p]), kNoiseFree);
        expectInOrder(edges_, e, curve.spacing, 1.6);
    }
    EXPECT_GT(static_cast<double>(edges_.observations.size()), 0.99 * static_cast<double>(keyframePoints()));
}

TEST_F(EdgeFusion, AnObservationIsAPointOfTheSamePlace) {
    fuseViews({seeAll(curves_), seeAll(curves_, 0.25), seeAll(curves_, 0.5)});
    for (int e = 0; e < edges_.numEdges(); ++e) {
        const double spacing = curves_[at(edges_.clusters[at(e)])].spacing;
        for (std::size_t p = at(edges_.begin[at(e)]); p < at(edges_.begin[at(e) + 1]); ++p) {
            for (std::size_t k = at(edges_.observation_begin[p]); k < at(edges_.observation_begin[p + 1]);
                 ++k) {
                const Observation& seen = edges_.observations[k];
                const WindowKeyframe& view = window_[at(seen.slot)];
                const Eigen::Vector3d shown = view.T_world_camera * view.keyframe->points.at(at(seen.point));
                ASSERT_LT((shown - edges_.points[p]).norm(), 0.6 * spacing)
                    << "half a step and the curve's bend";
            }
        }
    }
}

TEST_F(EdgeFusion, PartialViewsMakeTheUnion) {
    const int end = curves_[0].samples();
    struct Case {
        const char* name;
        std::vector<std::vector<Sighting>> views;
        double phase;
    };
    // The longest view is the reference, wherever it lies
    const std::vector<Case> cases{
        {"at the back", {{{0, 0, 70}}, {{0, 40, end}}}, 0},
        {"at the front", {{{0, 60, end}}, {{0, 0, 90}}}, 0},
        {"on both sides", {{{0, 60, 190}}, {{0, 0, 90}}, {{0, 160, end}}}, 0},
        {"one longer on both sides, shorter in points",
         {{{0, 60, 190}}, {{0, 0, 90}}, {{0, 20, 140}}, {{0, 120, end}}},
         0},
        {"reversed at the back", {{{0, 0, 150}}, {{0, 120, end, 0, true}}}, 0},
        {"reversed at the front", {{{0, 100, end}}, {{0, 0, 130, 0, true}}}, 0},
        {"reversed reference", {{{0, 60, 200, 0, true}}, {{0, 0, 90}}, {{0, 170, end}}}, 0},
        {"other samples", {{{0, 0, 150}}, {{0, 120, end - 1, 0.4}}, {{0, 100, 200, 0.7, true}}}, 0},
        {"a chain of pieces, each joined to the last",
         {{{0, 0, 80}}, {{0, 60, 130}}, {{0, 110, 170}}, {{0, 155, 210}}, {{0, 195, end}}},
         0},
    };
    ASSERT_GT(end, 220) << "the cases count on it";
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        fuseViews(c.views);
        ASSERT_EQ(edges_.numEdges(), 1);
        EXPECT_NEAR(lengthOf(edges_, 0), (end - 1) * curves_[0].spacing, 1.1 * curves_[0].spacing);
        expectInOrder(edges_, 0, curves_[0].spacing, 1.6);
        EXPECT_EQ(edges_.views[0], static_cast<int>(c.views.size()));
        for (const auto& p : edges_.points) ASSERT_LT(distanceTo(curves_[0], p), kNoiseFree);
        EXPECT_EQ(edges_.observations.size(), keyframePoints()) << "all that was seen is on the edge";
    }
}

TEST_F(EdgeFusion, ArcsAreStitchedToo) {
    const int end = curves_[3].samples();
    fuseViews({{{3, 0, end / 2}}, {{3, end / 3, end, 0.5}}, {{3, end / 4, 3 * end / 4, 0.2, true}}});
    ASSERT_EQ(edges_.numEdges(), 1);
    expectInOrder(edges_, 0, curves_[3].spacing, 1.6);
    for (const auto& p : edges_.points) ASSERT_LT(distanceTo(curves_[3], p), kNoiseFree);
    EXPECT_NEAR(lengthOf(edges_, 0), (end - 1) * curves_[3].spacing, 2 * curves_[3].spacing);
}

TEST_F(EdgeFusion, AGapIsNotBridged) {
    // Two pieces with nothing in between, in one cluster by mistake or by a third that is gone
    fuseViews({{{0, 0, 90}}, {{0, 150, 220}}});
    ASSERT_EQ(edges_.numEdges(), 2);
    for (int e = 0; e < 2; ++e) expectInOrder(edges_, e, curves_[0].spacing, 1.6);
    EXPECT_EQ(edges_.clusters, (std::vector<std::int32_t>{0, 0}));
    EXPECT_EQ(edges_.verdicts[0], EdgeVerdict::kUnconfirmed);
}

TEST_F(EdgeFusion, TheOrderOfTheKeyframesDoesNotMatterForTheUnion) {
    const int end = curves_[0].samples();
    const std::vector<std::vector<Sighting>> views{
        {{0, 0, 81}}, {{0, 60, 142}}, {{0, 120, 203}}, {{0, 180, end}}};
    std::vector<std::size_t> order{0, 1, 2, 3};
    do {
        std::vector<std::vector<Sighting>> shuffled;
        for (const std::size_t k : order) shuffled.push_back(views[k]);
        fuseViews(shuffled);
        ASSERT_EQ(edges_.numEdges(), 1) << order[0] << order[1] << order[2] << order[3];
        ASSERT_NEAR(lengthOf(edges_, 0), (end - 1) * curves_[0].spacing, 1.1 * curves_[0].spacing);
        expectInOrder(edges_, 0, curves_[0].spacing, 1.6);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(EdgeFusion, ParallelLinesInOneClusterStayApart) {
    for (const double depth : {1.0, 1.5, 2.0}) {
        SCOPED_TRACE(depth);
        expectParallelLinesApart(depth);
    }
}

// Fails: what counts as near grows with the depth noise in all directions, not along the ray only. At 3 m
// lines 17 px apart in the image become one edge.
TEST_F(EdgeFusion, FarParallelLinesInOneClusterStayApart) {
    for (const double depth : {3.0, 4.0}) {
        SCOPED_TRACE(depth);
        expectParallelLinesApart(depth);
    }
}

// Fails: past the seam the search stays at the end where it is until that is out of reach (7 cm), and what is
// in between is stitched to the end a second time.
TEST_F(EdgeFusion, AClosedCurveSeenFromDifferentStartsIsOneEdge) {
    const auto circle = [](double start) {
        return Curve{[=](double s) {
                         return Eigen::Vector3d(0.3 * std::cos(start + s / 0.3),
                                                0.3 * std::sin(start + s / 0.3), 2);
                     },
                     0.3 * 2 * kPi - 0.004, kSpacingPixels * 2 / 525};
    };
    curves_ = {circle(0), circle(kPi / 2), circle(-2)};
    fuseViews({{{0}}, {{1}}, {{2, 0, -1, 0, true}}}, false);
    ASSERT_EQ(edges_.numEdges(), 1);
    EXPECT_EQ(edges_.views[0], 3);
    expectInOrder(edges_, 0, curves_[0].spacing, 1.6);
    EXPECT_NEAR(lengthOf(edges_, 0), curves_[0].length, 3 * curves_[0].spacing);
}

TEST_F(EdgeFusion, ASparseViewOfTheWholeIsStitchedToBothEndsOfADensePart) {
    curves_[1] = curves_[0];
    curves_[1].spacing *= 2.5;  // from farther away
    const int dense = curves_[0].samples();
    fuseViews({{{0, 70, 175}}, {{1}}, {{0, 0, 40}}, {{1, 0, -1, 0.5, true}}}, false);
    ASSERT_GT(105, curves_[1].samples()) << "the dense part is the reference";
    ASSERT_EQ(edges_.numEdges(), 1);
    expectInOrder(edges_, 0, curves_[1].spacing, 1.6);
    EXPECT_NEAR(lengthOf(edges_, 0), (dense - 1) * curves_[0].spacing, 1.5 * curves_[1].spacing);
    // The last view begins half a step further on: its one point beyond the end is too short a run
    EXPECT_GE(edges_.observations.size() + 2, keyframePoints());
}

TEST_F(EdgeFusion, CrossingLinesInOneClusterAreNotFolded) {
    curves_ = {segment({-0.5, 0, 2}, {0.5, 0, 2}), segment({0, -0.4, 2}, {0, 0.4, 2})};
    fuseViews({{{0}, {1}}, {{0}, {1}}}, false);
    for (int e = 0; e < edges_.numEdges(); ++e) expectInOrder(edges_, e, curves_[0].spacing, 3);
    // Both lines are there in full
    double total = 0;
    for (int e = 0; e < edges_.numEdges(); ++e) total += lengthOf(edges_, e);
    EXPECT_GT(total, 1.6);
    EXPECT_LT(total, 1.85);
}

TEST_F(EdgeFusion, AnEdgeOfDriftedPosesStaysInOrder) {
    std::mt19937 random(3);
    made_ = walkThrough(curves_, 6, true);
    for (int round = 0; round < 20; ++round) {
        window_ = windowOf(made_);
        disturb(window_, random, 0.005, 0.5 * kDegree);
        edges_ = fuse(window_, clustersByCurve(made_));
        expectSound(edges_, window_);
        for (int e = 0; e < edges_.numEdges(); ++e) {
            // Where a run is stitched there is a step of the drift's size
            const double spacing = curves_[at(edges_.clusters[at(e)])].spacing;
            for (std::size_t p = at(edges_.begin[at(e)]) + 1; p < at(edges_.begin[at(e) + 1]); ++p)
                ASSERT_LT((edges_.points[p] - edges_.points[p - 1]).norm(), 0.06 + 2 * spacing)
                    << "round " << round << " curve " << edges_.clusters[at(e)];
        }
        EXPECT_GT(static_cast<double>(edges_.observations.size()),
                  0.95 * static_cast<double>(keyframePoints()));
    }
}

TEST_F(EdgeFusion, AShortEdgeAndAnEmptyWindow) {
    fuseViews({{{0, 0, 1}}, {{0, 0, 1}}, {{0, 0, 2}}});
    EXPECT_GE(edges_.numEdges(), 1);
    fuseViews({});
    EXPECT_EQ(edges_.numEdges(), 0);
    fuseViews({{}, {{1}}});
    EXPECT_EQ(edges_.numEdges(), 1);
    EXPECT_EQ(observationsOf(edges_, 0), made_[1].keyframe.size());
}

}  // namespace
}  // namespace roevo
