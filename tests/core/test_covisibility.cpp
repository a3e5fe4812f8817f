// Which edges of keyframes show the same curve of the world.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/support/mapping_world.h"
#include "mapping/covisibility.h"

namespace roevo {
namespace {

using namespace testing;

using Clusters = std::vector<std::vector<int>>;

class Covisibility : public ::testing::Test {
  protected:
    /// Inserts keyframes in this order, each related to all that were inserted before, the newest first.
    static void insertAll(CovisibilityGraph& graph, const std::vector<const TestKeyframe*>& keyframes) {
        for (std::size_t k = 0; k < keyframes.size(); ++k) {
            std::vector<const MapKeyframe*> others;
            for (std::size_t j = k; j-- > 0;) others.push_back(&keyframes[j]->keyframe);
            graph.insert(keyframes[k]->keyframe, others, FineOptions().final_radius);
        }
    }
    static std::vector<const TestKeyframe*> pointers(const std::vector<TestKeyframe>& keyframes) {
        std::vector<const TestKeyframe*> all;
        for (const TestKeyframe& made : keyframes) all.push_back(&made);
        return all;
    }
    static std::vector<const MapKeyframe*> maps(const std::vector<const TestKeyframe*>& keyframes) {
        std::vector<const MapKeyframe*> all;
        for (const TestKeyframe* made : keyframes) all.push_back(&made->keyframe);
        return all;
    }
    /// Clusters and curves must be the same partition: one number per curve, one curve per number.
    static void expectCurves(const Clusters& clusters, const std::vector<const TestKeyframe*>& keyframes) {
        ASSERT_EQ(clusters.size(), keyframes.size());
        std::map<int, std::set<int>> of_curve, of_cluster;
        for (std::size_t k = 0; k < keyframes.size(); ++k) {
            ASSERT_EQ(clusters[k].size(), keyframes[k]->curve_of_edge.size());
            for (std::size_t e = 0; e < clusters[k].size(); ++e) {
                of_curve[keyframes[k]->curve_of_edge[e]].insert(clusters[k][e]);
                of_cluster[clusters[k][e]].insert(keyframes[k]->curve_of_edge[e]);
            }
        }
        for (const auto& [curve, found] : of_curve) EXPECT_EQ(found.size(), 1U) << "curve " << curve;
        for (const auto& [cluster, found] : of_cluster) EXPECT_EQ(found.size(), 1U) << "cluster " << cluster;
    }

    /// Points of `a`'s edges that were associated with `b`, where a is the newer.
    int sharedPoints(int a, int b) const {
        int points = 0;
        for (const CovisibilityGraph::Links& group : graph_.linksOf(a))
            for (const CovisibilityGraph::Link& link : group.links)
                if (group.other == b) points += link.points;
        return points;
    }

    std::vector<Curve> curves_ = room();
    CovisibilityGraph graph_{mappingCamera(), FineOptions()};
};

TEST_F(Covisibility, EdgesOfOneCurveAreOneClusterOverKeyframes) {
    const auto made = walkThrough(curves_, 6, true);
    const auto all = pointers(made);
    insertAll(graph_, all);
    const Clusters clusters = graph_.clusters(maps(all));
    expectCurves(clusters, all);
    // Numbered in the order of first appearance
    int next = 0;
    for (const auto& of_edges : clusters) {
        for (const int cluster : of_edges) {
            ASSERT_LE(cluster, next);
            next = std::max(next, cluster + 1);
        }
    }
    EXPECT_EQ(next, static_cast<int>(curves_.size()));
}

TEST_F(Covisibility, TurnedAndReversedViewsAreRecognised) {
    auto sightings = seeAll(curves_);
    for (auto& sighting : sightings) sighting.reversed = true;
    Vector6d roll = Vector6d::Zero();
    roll[5] = 20 * kDegree;
    const TestKeyframe first = makeKeyframe(0, Pose::Identity(), curves_, seeAll(curves_));
    const TestKeyframe turned = makeKeyframe(1, poseIncrement(roll), curves_, sightings);
    insertAll(graph_, {&first, &turned});
    expectCurves(graph_.clusters({&first.keyframe, &turned.keyframe}), {&first, &turned});
    EXPECT_GT(sharedPoints(1, 0), static_cast<int>(0.9 * static_cast<double>(turned.keyframe.size())));
}

TEST_F(Covisibility, TheOtherSideOfALineIsAnotherEdge) {
    // Both borders of a thin dark stripe: 2 px apart, so within the radius, and bright on opposite sides
    const std::vector<Curve> stripe{segment({-0.5, 0, 2}, {0.5, 0, 2}),
                                    segment({0.5, 0.0077, 2}, {-0.5, 0.0077, 2})};
    const TestKeyframe first = makeKeyframe(0, placeOnPath(0), stripe, seeAll(stripe));
    const TestKeyframe second = makeKeyframe(1, placeOnPath(1), stripe, seeAll(stripe));
    insertAll(graph_, {&first, &second});
    expectCurves(graph_.clusters({&first.keyframe, &second.keyframe}), {&first, &second});
}

TEST_F(Covisibility, AnEdgeOnceAssociatedIsNotLinkedToOlderKeyframes) {
    const TestKeyframe oldest = makeKeyframe(0, placeOnPath(0), curves_, seeAll(curves_));
    // The middle one lacks curve 2, so that the newest has it from the oldest alone
    auto without = seeAll(curves_);
    without.erase(without.begin() + 2);
    const TestKeyframe middle = makeKeyframe(1, placeOnPath(1), curves_, without);
    const TestKeyframe newest = makeKeyframe(2, placeOnPath(2), curves_, seeAll(curves_));
    insertAll(graph_, {&oldest, &middle, &newest});
    const auto pointsOf = [&](int curve) {
        const auto& image = newest.keyframe.image;
        return image.begin[static_cast<std::size_t>(curve) + 1] -
               image.begin[static_cast<std::size_t>(curve)];
    };
    EXPECT_EQ(sharedPoints(2, 0), pointsOf(2)) << "all of curve 2 and nothing else";
    EXPECT_GT(sharedPoints(2, 1), 0);
    EXPECT_LE(sharedPoints(2, 1), static_cast<int>(newest.keyframe.size()) - pointsOf(2));
    EXPECT_EQ(sharedPoints(0, 2), 0) << "kept by the newer one";
    EXPECT_EQ(sharedPoints(7, 0), 0) << "unknown keyframe";
    expectCurves(graph_.clusters({&oldest.keyframe, &middle.keyframe, &newest.keyframe}),
                 {&oldest, &middle, &newest});
    // Transitively: the oldest and the newest share curve 0 only by the middle one
    const Clusters two = graph_.clusters({&oldest.keyframe, &newest.keyframe});
    EXPECT_EQ(two[0][2], two[1][2]);
    EXPECT_NE(two[0][0], two[1][0]);
}

TEST_F(Covisibility, FragmentsOfAnEdgeAreJoinedByTheWholeOne) {
    const int samples = curves_[0].samples(), third = samples / 3;
    const std::vector<Sighting> cut{
        {0, 0, third - 3}, {0, third, 2 * third - 3}, {0, 2 * third, samples}, {1}};
    const TestKeyframe fragments = makeKeyframe(0, placeOnPath(0), curves_, cut);
    const TestKeyframe whole = makeKeyframe(1, placeOnPath(1), curves_, {{0}, {1}});
    ASSERT_EQ(fragments.keyframe.image.numEdges(), 4);
    insertAll(graph_, {&fragments, &whole});
    expectCurves(graph_.clusters({&fragments.keyframe, &whole.keyframe}), {&fragments, &whole});

    // The other way round, the whole edge older than its fragments
    CovisibilityGraph other(mappingCamera(), FineOptions());
    TestKeyframe later = fragments;
    later.keyframe.id = 2;
    insertAll(other, {&whole, &later});
    expectCurves(other.clusters({&whole.keyframe, &later.keyframe}), {&whole, &later});
    // Alone, fragments are edges of their own
    EXPECT_EQ(other.clusters({&later.keyframe})[0], (std::vector<int>{0, 1, 2, 3}));
}

TEST_F(Covisibility, TheOrderInWhichUnrelatedKeyframesComeDoesNotMatter) {
    // Two groups that see different curves of the world
    const std::vector<Sighting> left{{0}, {1}, {3}}, right{{2}, {5}, {7}};
    std::vector<TestKeyframe> made;
    for (int k = 0; k < 3; ++k) made.push_back(makeKeyframe(k, placeOnPath(k), curves_, left));
    for (int k = 3; k < 6; ++k) made.push_back(makeKeyframe(k, placeOnPath(k), curves_, right));
    const auto all = pointers(made);
    insertAll(graph_, all);
    CovisibilityGraph mixed(mappingCamera(), FineOptions());
    insertAll(mixed, {all[3], all[0], all[4], all[1], all[2], all[5]});
    const Clusters clusters = graph_.clusters(maps(all));
    EXPECT_EQ(clusters, mixed.clusters(maps(all)));
    expectCurves(clusters, all);
}

TEST_F(Covisibility, KeyframesOfAnotherTimeAreRelatedOnTheirOwn) {
    const auto made = walkThrough(curves_, 3);
    graph_.insert(made[0].keyframe, {}, 3);
    graph_.insert(made[1].keyframe, {}, 3);
    graph_.insert(made[2].keyframe, {&made[1].keyframe}, 3);
    EXPECT_EQ(sharedPoints(2, 0), 0);
    graph_.insert(made[2].keyframe, {&made[0].keyframe}, 3);
    EXPECT_EQ(sharedPoints(2, 0), sharedPoints(2, 1));
    const auto all = pointers(made);
    expectCurves(graph_.clusters(maps(all)), all);
}

TEST_F(Covisibility, NothingInCommonAndNothingAtAll) {
    TestKeyframe empty = makeKeyframe(0, placeOnPath(0), curves_, {});
    const TestKeyframe full = makeKeyframe(1, placeOnPath(1), curves_, seeAll(curves_));
    TestKeyframe after = empty;
    after.keyframe.id = 2;
    insertAll(graph_, {&empty, &full, &after});
    const Clusters clusters = graph_.clusters({&empty.keyframe, &full.keyframe, &after.keyframe});
    EXPECT_TRUE(clusters[0].empty());
    EXPECT_EQ(clusters[1].size(), curves_.size());
    EXPECT_TRUE(graph_.clusters({}).empty());
}

}  // namespace
}  // namespace roevo
