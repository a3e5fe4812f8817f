// Bundle adjustment of a window: what it converges to, and how fast.
#include "core/support/bundle_fixture.h"
#include "mapping/pseudo_edges.h"

namespace roevo {
namespace {

using namespace testing;

TEST_F(BundleAdjustment, ExactPosesStay) {
    for (const bool joint : {true, false}) {
        mapping_.joint_refinement = joint;
        window_ = truth_;
        const FusedEdges before = edges_;
        const Refined result = refine(10);
        EXPECT_LT(positionError(window_), 1e-6);
        EXPECT_LT(rotationError(window_), 1e-6);
        EXPECT_EQ(result.iterations, 1) << "still at once";
        for (std::size_t p = 0; p < edges_.points.size(); ++p)
            ASSERT_LT((edges_.points[p] - before.points[p]).norm(), 1e-5);
        for (std::size_t s = 0; s < window_.size(); ++s)
            EXPECT_GT(result.inliers[s], 0.99 * static_cast<double>(made_[s].keyframe.size()));
    }
}

TEST_F(BundleAdjustment, DriftedPosesConvergeToTheTruth) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        drift(seed);
        ASSERT_GT(positionError(window_), 1e-3);
        fuseAndRefine(2, 10);
        EXPECT_LT(positionError(window_), 2e-4) << seed;
        EXPECT_LT(rotationError(window_), 1e-4) << seed;
    }
}

TEST_F(BundleAdjustment, StepsOfManyKeyframesSolveTheEquationsSparseOrNot) {
    constexpr int kKeyframes = 56, kRoomsAlongAWay = 18;
    for (const int rooms : {1, kRoomsAlongAWay}) {
        std::vector<Curve> curves;
        for (int r = 0; r < rooms; ++r)
            for (const Curve& curve : room())
                curves.push_back({[=](double s) {
                                      return Eigen::Vector3d(curve.at(s).x() + r, curve.at(s).y(),
                                                             curve.at(s).z());
                                  },
                                  curve.length, curve.spacing});
        std::vector<TestKeyframe> made;
        for (int k = 0; k < kKeyframes; ++k) {
            const int at = k * rooms / kKeyframes;
            std::vector<Sighting> seen;
            for (Sighting sighting : seeAll(curves))
                if (const int r = sighting.curve / static_cast<int>(room().size()); r == at || r == at + 1)
                    seen.push_back(sighting);
            made.push_back(makeKeyframe(
                k, Pose(Eigen::Quaterniond::Identity(), {static_cast<double>(at), 0, 0}) * placeOnPath(k % 4),
                curves, seen));
        }
        std::vector<WindowKeyframe> window = windowOf(made);
        std::mt19937 random(3);
        disturb(window, random, 0.002, 0.1 * kDegree);
        FusedEdges edges = fuse(window, clustersByCurve(made));
        WindowEquations equations(mapping_, sensor_, mappingCamera());
        equations.gather(window, edges);
        equations.evaluate(window, edges.points, 0.5);
        equations.build(window, edges.points);
        equations.addDamping(5e-6);
        Eigen::MatrixXd hessian = equations.hessian().selfadjointView<Eigen::Upper>();
        ASSERT_GT(hessian.rows(), 300) << "fewer are dense";
        const double filled = (hessian.array() != 0).cast<double>().mean();
        EXPECT_TRUE(rooms == 1 ? filled > 0.9 : filled < 0.2) << filled;
        const Eigen::VectorXd expected = -hessian.fullPivLu().solve(equations.gradient);
        EXPECT_LT((equations.step() - expected).norm(), 1e-6 * expected.norm()) << rooms;
    }
}

// Not all of a point's pairs of keyframes make the Hessian then.
TEST_F(BundleAdjustment, ManyKeyframesOfOneRoomConvergeAsFewDo) {
    std::vector<TestKeyframe> made;
    for (int k = 0; k < 80; ++k) made.push_back(makeKeyframe(k, placeOnPath(k % 6), room(), seeAll(room())));
    look(std::move(made));
    drift();
    ASSERT_GT(positionError(window_), 1e-3);
    fuseAndRefine(2, 5);
    EXPECT_LT(positionError(window_), 2e-4);
    EXPECT_LT(rotationError(window_), 1e-4);
}

// Far points of a sensor that is trusted nearby only: weights underflow.
TEST_F(BundleAdjustment, PointsWithoutAnyWeightTellNothing) {
    std::vector<TestKeyframe> made = made_;
    for (TestKeyframe& each : made)
        for (std::size_t i = 0; i < each.keyframe.size(); ++i)
            if (each.keyframe.image.edge_of[i] % 3 == 0) each.keyframe.weight[i] = 0;
    look(std::move(made));
    drift();
    fuseAndRefine(2, 10);
    for (const WindowKeyframe& view : window_) EXPECT_TRUE(view.T_world_camera.isFinite());
    EXPECT_LT(positionError(window_), 4e-4);
    for (const Eigen::Vector3d& point : edges_.points) EXPECT_TRUE(point.allFinite());
}

TEST_F(BundleAdjustment, JointNeedsFewerIterationsThanAlternating) {
    int joint = 0, alternating = 0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        mapping_.joint_refinement = true;
        drift(seed);
        const int needed = iterationsTo(5e-4, 8);
        EXPECT_LE(needed, 4) << seed;
        joint += needed;
        mapping_.joint_refinement = false;
        drift(seed);
        alternating += iterationsTo(5e-4, 40);
    }
    EXPECT_GT(alternating, 4 * joint);
}

TEST_F(BundleAdjustment, AlternatingConvergesFromASmallDrift) {
    mapping_.joint_refinement = false;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        drift(seed, 0.25);
        ASSERT_GT(positionError(window_), 1e-3);
        refineToTheEnd(100);
        EXPECT_LT(positionError(window_), 5e-5) << seed;
        EXPECT_LT(rotationError(window_), 3e-5) << seed;
    }
}

TEST_F(BundleAdjustment, AWindowThatDriftedAsAWholeComesBack) {
    for (const double metres : {0.005, 0.01, 0.02}) {
        window_ = truth_;
        for (auto& view : window_) {
            if (!view.fixed) view.T_world_camera.translation() += Eigen::Vector3d(metres, metres / 2, 0);
        }
        fuseAndRefine(2, 10);
        EXPECT_LT(positionError(window_), 2e-4) << metres;
    }
}

// Those that drifted agree among themselves before they are back: with one spread for all, the observations
// of the fixed keyframe would be outliers for ever.
TEST_F(BundleAdjustment, AlternatingHoldsOnToTheFixedKeyframe) {
    mapping_.joint_refinement = false;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        drift(seed);
        refineToTheEnd(100);
        EXPECT_LT(positionError(window_), 5e-4) << seed;
        EXPECT_GT(refine(1).inliers[0], 0.9 * static_cast<double>(made_[0].keyframe.size())) << seed;
    }
}

TEST_F(BundleAdjustment, OtherSamplesOfTheCurvesBiasNothing) {
    // Fused points then lie up to half a step beside the observed ones, along the edge
    look(walkThrough(room(), 6, true));
    refineToTheEnd(30);
    EXPECT_LT(positionError(window_), 1e-4);
    EXPECT_LT(rotationError(window_), 3e-5);
}

TEST_F(BundleAdjustment, FixedKeyframesNeverMove) {
    drift();
    window_[3].fixed = true;
    window_[3].T_world_camera = truth_[3].T_world_camera;
    const auto before = window_;
    fuseAndRefine(2, 4);
    for (const std::size_t s : {0U, 3U})
        EXPECT_EQ(window_[s].T_world_camera.matrix(), before[s].T_world_camera.matrix()) << s;
    EXPECT_LT(positionError(window_), 2e-4);

    drift();
    for (auto& view : window_) view.fixed = true;
    const auto all = window_;
    const Refined result = refine(3);
    for (std::size_t s = 0; s < all.size(); ++s) {
        EXPECT_EQ(window_[s].T_world_camera.matrix(), all[s].T_world_camera.matrix());
        EXPECT_GT(result.inliers[s], 0);
    }
}

TEST_F(BundleAdjustment, ARigidMotionOfTheWorldMovesTheResultAlong) {
    Vector6d xi;
    xi << 4, -7, 2, 0.9, -1.4, 0.6;
    const Pose motion = poseIncrement(xi);
    drift();
    auto moved = window_;
    FusedEdges moved_edges = edges_;
    for (auto& view : moved) view.T_world_camera = motion * view.T_world_camera;
    for (auto& p : moved_edges.points) p = motion * p;
    // On the way there they differ, since rotations are about the world's origin
    for (int k = 0; k < 30; ++k) adjuster().refine(moved, moved_edges, {}, 1);
    refineToTheEnd(30);
    for (std::size_t s = 0; s < window_.size(); ++s) {
        const Pose expected = motion * window_[s].T_world_camera;
        EXPECT_LT((expected.matrix() - moved[s].T_world_camera.matrix()).norm(), 2e-6) << s;
    }
}

TEST_F(BundleAdjustment, AGrossOutlierDoesNoHarm) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SetUp();
        drift(seed);
        OrganizedEdges& image = made_[3].keyframe.image;
        for (std::int32_t i = image.begin[0]; i < image.begin[1]; ++i)
            image.y[static_cast<std::size_t>(i)] += 20;
        refine(8);
        EXPECT_LT(positionError(window_), 3e-4);
        EXPECT_LT(rotationError(window_), 2e-4);
    }
}

TEST_F(BundleAdjustment, AKeyframeWithoutObservationsStaysAndStaysFinite) {
    std::vector<TestKeyframe> made = walkThrough(room(), 4);
    made.push_back(makeKeyframe(4, placeOnPath(4), room(), {}));
    made.insert(made.begin() + 2,
                makeKeyframe(5, placeOnPath(5), {segment({-0.1, 0, 1.5}, {0.1, 0, 1.5})}, {{0}}));
    made[2].curve_of_edge = {99};
    look(std::move(made));
    drift();
    const auto before = window_;
    const Refined result = fuseAndRefine(2, 4);
    for (const std::size_t s : {2U, 5U}) {
        EXPECT_LT((window_[s].T_world_camera.matrix() - before[s].T_world_camera.matrix()).norm(), 1e-12);
    }
    EXPECT_EQ(result.inliers[5], 0);
    for (const std::size_t s : {1U, 3U, 4U}) {
        const Pose error = made_[s].keyframe.T_world_camera.inverse() * window_[s].T_world_camera;
        EXPECT_LT(error.translation().norm(), 3e-4) << s;
    }
}

TEST_F(BundleAdjustment, NothingToRefine) {
    std::vector<WindowKeyframe> none;
    FusedEdges no_edges;
    EXPECT_EQ(adjuster().refine(none, no_edges, {}, 5), 0);
    PseudoEdgeJudge(mapping_, sensor_, mappingCamera()).judge(none, no_edges, 1);
    // One keyframe alone, fixed or not
    for (const bool fixed : {true, false}) {
        std::vector<WindowKeyframe> one{truth_[1]};
        one[0].fixed = fixed;
        FusedEdges own = fuse(one, {made_[1].curve_of_edge});
        adjuster().refine(one, own, {}, 5);
        EXPECT_LT((one[0].T_world_camera.matrix() - truth_[1].T_world_camera.matrix()).norm(), 1e-12);
    }
    // No iterations
    drift();
    const auto before = window_;
    EXPECT_EQ(refine(0).iterations, 0);
    // All edges are pseudo-edges
    std::fill(edges_.verdicts.begin(), edges_.verdicts.end(), EdgeVerdict::kSpread);
    refine(5);
    for (std::size_t s = 0; s < window_.size(); ++s)
        EXPECT_LT((window_[s].T_world_camera.matrix() - before[s].T_world_camera.matrix()).norm(), 1e-12);
}

TEST_F(BundleAdjustment, WithoutDepthOnlyTheScaleIsFree) {
    mapping_.depth_weight = 0;
    drift(2);
    refineToTheEnd(40);
    // Positions relative to the fixed first camera are the true ones but for one factor
    const Eigen::Vector3d origin = truth_[0].T_world_camera.translation();
    const double scale = (window_[5].T_world_camera.translation() - origin).norm() /
                         (truth_[5].T_world_camera.translation() - origin).norm();
    EXPECT_NEAR(scale, 1, 0.2);
    for (std::size_t s = 1; s < window_.size(); ++s) {
        const Eigen::Vector3d expected = scale * (truth_[s].T_world_camera.translation() - origin);
        const Eigen::Vector3d found = window_[s].T_world_camera.translation() - origin;
        EXPECT_LT((found - expected).norm(), 3e-4) << s;
    }
    EXPECT_LT(rotationError(window_), 2e-4);
}

TEST_F(BundleAdjustment, APriorPlacesAKeyframeThatSeesNothing) {
    std::vector<TestKeyframe> made = walkThrough(room(), 3);
    for (int k = 3; k < 5; ++k) made.push_back(makeKeyframe(k, placeOnPath(k), room(), {}));
    look(std::move(made));
    drift();
    std::vector<RelativePrior> priors;
    for (const int to : {3, 4}) {  // 4 hangs on 3, which hangs on 2, which is refined
        RelativePrior prior;
        prior.from = to - 1;
        prior.to = to;
        prior.T_from_to = truth_[static_cast<std::size_t>(prior.from)].T_world_camera.inverse() *
                          truth_[static_cast<std::size_t>(to)].T_world_camera;
        prior.information = 1e6 * Matrix6d::Identity();
        priors.push_back(prior);
    }
    for (int k = 0; k < 15; ++k) refine(1, priors);
    const Pose expected = window_[2].T_world_camera * priors[0].T_from_to;
    EXPECT_LT((window_[3].T_world_camera.matrix() - expected.matrix()).norm(), 1e-6);
    EXPECT_LT((window_[4].T_world_camera.matrix() - (expected * priors[1].T_from_to).matrix()).norm(), 1e-6);
    EXPECT_LT(positionError(window_), 5e-4);
}

}  // namespace
}  // namespace roevo
