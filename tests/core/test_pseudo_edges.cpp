// What bundle adjustment thinks of edges: true ones, those that move, and those that are seen too rarely.
#include <gtest/gtest.h>

#include "core/support/mapping_world.h"
#include "mapping/bundle_adjustment.h"
#include "mapping/pseudo_edges.h"

namespace roevo {
namespace {

using namespace testing;

/// m. Before they are judged, edges that move have pulled poses off by a few millimetres.
constexpr double kHarm = 8e-4;
constexpr int kJudged = 2;  ///< curve that the tests are about

constexpr int kPieces = 100;  ///< clusters from here on hold what nothing was associated with

class PseudoEdges : public ::testing::Test {
  protected:
    /// Keyframes with all curves but the judged one, which `sees` adds where it is to be seen.
    template <class Sees>
    void look(int count, Sees&& sees) {
        made_.clear();
        for (int k = 0; k < count; ++k) {
            std::vector<Sighting> sightings;
            for (int c = 0; c < static_cast<int>(curves_.size()); ++c) {
                Sighting sighting{c};
                if (c != kJudged || sees(k, sighting)) sightings.push_back(sighting);
            }
            made_.push_back(makeKeyframe(k, placeOnPath(k), curves_, sightings));
        }
    }
    void setFound(float share) {
        for (auto& made : made_) {
            for (std::size_t e = 0; e < made.curve_of_edge.size(); ++e) {
                if (made.curve_of_edge[e] == kJudged) made.keyframe.found[e] = share;
            }
        }
    }
    /// As the mapper goes about it: a few iterations, then the verdicts. Verdict of the judged curve; the
    /// others must be true.
    EdgeVerdict judge(double drift = 0.002) {
        window_ = windowOf(made_);
        std::mt19937 random(5);
        disturb(window_, random, drift, drift);
        edges_ = fuse(window_, clustersByCurve(made_));
        BundleAdjuster adjuster(mapping_, SensorOptions(), mappingCamera());
        adjuster.refine(window_, edges_, {}, 3);
        PseudoEdgeJudge(mapping_, SensorOptions(), mappingCamera())
            .judge(window_, edges_, adjuster.equations().scale);
        EdgeVerdict verdict = EdgeVerdict::kUnconfirmed;
        for (std::size_t e = 0; e < edges_.verdicts.size(); ++e) {
            if (edges_.clusters[e] == kJudged) {
                verdict = edges_.verdicts[e];
            } else if (edges_.clusters[e] < kPieces) {
                EXPECT_EQ(edges_.verdicts[e], EdgeVerdict::kTrue) << "curve " << edges_.clusters[e];
            }
        }
        adjuster.refine(window_, edges_, {}, 5);
        EXPECT_LT(positionError(window_), kHarm) << "it must not pull at the poses either";
        return verdict;
    }

    std::vector<Curve> curves_ = room();
    MappingOptions mapping_;
    std::vector<TestKeyframe> made_;
    std::vector<WindowKeyframe> window_;
    FusedEdges edges_;
};

TEST_F(PseudoEdges, WhatStandsStillIsTrue) {
    look(5, [](int, Sighting&) { return true; });
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
    look(2, [](int, Sighting&) { return true; });
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
}

TEST_F(PseudoEdges, AnEdgeThatMovesBetweenKeyframesIsSpread) {
    // The edge of a shadow that wanders 3 px from keyframe to keyframe, across itself
    const auto wander = [](double pixels) {
        return [pixels](int k, Sighting& sighting) {
            sighting.shift = pixels * k * Eigen::Vector2d(0.857, -0.514);
            return true;
        };
    };
    look(5, wander(3));
    EXPECT_EQ(judge(), EdgeVerdict::kSpread);
    look(5, wander(-3));
    EXPECT_EQ(judge(), EdgeVerdict::kSpread);
    // Along itself there is nothing to be seen of it
    look(5, [](int k, Sighting& sighting) {
        sighting.shift = 3.0 * k * Eigen::Vector2d(0.514, 0.857);
        return true;
    });
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
}

TEST_F(PseudoEdges, AnEdgeThatOneOfFiveKeyframesSeesIsVanishing) {
    for (int only = 0; only < 5; ++only) {
        look(5, [only](int k, Sighting&) { return k == only; });
        EXPECT_EQ(judge(), EdgeVerdict::kVanishing) << only;
    }
    look(5, [](int k, Sighting&) { return k == 1 || k == 3; });
    EXPECT_EQ(judge(), EdgeVerdict::kVanishing) << "one of four others";
    // Not one that misses it between two that see it: that one looks from nearer by, and counts for a bit
    // more
    look(5, [](int k, Sighting&) { return k < 3; });
    EXPECT_EQ(judge(), EdgeVerdict::kTrue) << "two of four others";
}

TEST_F(PseudoEdges, FewLooksDoNotCondemn) {
    look(2, [](int k, Sighting&) { return k == 0; });
    EXPECT_EQ(judge(), EdgeVerdict::kUnconfirmed);
    // Of five keyframes only two have its place in their image
    look(5, [](int k, Sighting&) { return k < 2; });
    for (int k = 2; k < 5; ++k) {
        Vector6d away = Vector6d::Zero();
        away[4] = 60 * kDegree;
        TestKeyframe& made = made_[static_cast<std::size_t>(k)];
        made = makeKeyframe(k, made.keyframe.T_world_camera * poseIncrement(away), curves_, seeAll(curves_));
        ASSERT_EQ(std::count(made.curve_of_edge.begin(), made.curve_of_edge.end(), kJudged), 0);
    }
    window_ = windowOf(made_);
    edges_ = fuse(window_, clustersByCurve(made_));
    PseudoEdgeJudge(mapping_, SensorOptions(), mappingCamera()).judge(window_, edges_, 0.3);
    const auto at =
        std::find(edges_.clusters.begin(), edges_.clusters.end(), kJudged) - edges_.clusters.begin();
    EXPECT_EQ(edges_.verdicts[static_cast<std::size_t>(at)], EdgeVerdict::kTrue);
}

TEST_F(PseudoEdges, WhoLooksFromTheSideProvesLittle) {
    // Two of six keyframes see it; the others look at it from where they are carried around it
    const Curve& curve = curves_[kJudged];
    const Eigen::Translation3d centre(curve.at(curve.length / 2));
    const auto carried = [&](double degrees) {
        look(6, [](int k, Sighting&) { return k < 2; });
        for (int k = 2; k < 6; ++k) {
            TestKeyframe& made = made_[static_cast<std::size_t>(k)];
            const Eigen::AngleAxisd turn(degrees * kDegree, Eigen::Vector3d::UnitY());
            const Pose around(Eigen::Isometry3d(centre * turn * centre.inverse()));
            std::vector<Sighting> others;
            for (int c = 0; c < static_cast<int>(curves_.size()); ++c)
                if (c != kJudged) others.push_back({c});
            made = makeKeyframe(k, around * made.keyframe.T_world_camera, curves_, others);
        }
        return judge();
    };
    EXPECT_EQ(carried(5), EdgeVerdict::kVanishing);
    EXPECT_EQ(carried(35), EdgeVerdict::kTrue);
    EXPECT_EQ(carried(-35), EdgeVerdict::kTrue);
}

TEST_F(PseudoEdges, WhatTheFramesInBetweenHardlyFoundIsVanishing) {
    // Three of five keyframes see it: the frames between them decide
    const auto three = [](int k, Sighting&) { return k != 1 && k != 3; };
    look(5, three);
    setFound(0.02F);
    EXPECT_EQ(judge(), EdgeVerdict::kVanishing);
    look(5, three);
    setFound(0.9F);
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
    // They can also save one that only two see
    const auto two = [](int k, Sighting&) { return k == 1 || k == 3; };
    look(5, two);
    setFound(0.9F);
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
    // And judge what two keyframes alone could not
    look(2, [](int, Sighting&) { return true; });
    setFound(0);
    EXPECT_EQ(judge(), EdgeVerdict::kVanishing);
}

TEST_F(PseudoEdges, WhatTheImagesShowIsNotVanishingThoughNothingAssociatedIt) {
    // Two of six keyframes are associated; four more see it in pieces that went to other clusters
    const auto two = [](int k, Sighting&) { return k < 2; };
    look(6, two);
    EXPECT_EQ(judge(), EdgeVerdict::kVanishing);
    look(6, [](int, Sighting&) { return true; });
    for (std::size_t k = 2; k < 6; ++k) {
        for (int& curve : made_[k].curve_of_edge) {
            if (curve == kJudged) curve = kPieces + static_cast<int>(k);
        }
    }
    EXPECT_EQ(judge(), EdgeVerdict::kTrue);
}

}  // namespace
}  // namespace roevo
