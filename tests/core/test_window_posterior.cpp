// What the window knows of its newest keyframe, against many noisy windows and against what refining does.
#include <Eigen/Cholesky>
#include <numeric>

#include "core/support/bundle_fixture.h"
#include "mapping/window_posterior.h"
#include "tracking/relative_pose.h"

namespace roevo {
namespace {

using namespace testing;

constexpr double kShift = 0.4;  // px, one sigma, of an edge in a keyframe

/// Edges of three rooms, one behind the other.
std::vector<Curve> manyCurves() {
    std::vector<Curve> curves;
    for (const double further : {1.0, 1.25, 1.6})
        for (const Curve& curve : room())
            curves.push_back({[=](double s) { return Eigen::Vector3d(further * curve.at(s / further)); },
                              further * curve.length, further * curve.spacing});
    return curves;
}

class Posterior : public BundleAdjustment {
  protected:
    /// The first two keyframes are fixed: one from before the window, and the window's oldest.
    void see(unsigned seed, double sigma) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal(0, sigma);
        std::vector<TestKeyframe> made;
        for (int k = 0; k < 5; ++k) {
            std::vector<Sighting> sightings = seeAll(curves_);
            if (sigma > 0)
                for (Sighting& sighting : sightings) sighting.shift = {normal(random), normal(random)};
            made.push_back(makeKeyframe(k, placeOnPath(k), curves_, sightings));
        }
        look(std::move(made));
        window_[1].fixed = true;
    }
    std::optional<WindowPosterior> refined() {
        BundleAdjuster adjuster = this->adjuster();
        adjuster.refine(window_, edges_, priors_, 8);
        std::vector<std::int32_t> clusters(edges_.views.size());
        std::iota(clusters.begin(), clusters.end(), 0);
        return posteriorOf(window_, adjuster.equations(), clusters, priors_);
    }
    /// Of the newest keyframe, along its axes.
    Vector6d errorTo(const Pose& truth) const {
        const Pose error = truth.inverse() * window_.back().T_world_camera;
        const Eigen::AngleAxisd angle(error.linear());
        Vector6d out;
        out << error.translation(), angle.angle() * angle.axis();
        return out;
    }

    std::vector<Curve> curves_ = manyCurves();
    std::vector<RelativePrior> priors_;
};

TEST_F(Posterior, IsTheSpreadOfManyNoisyWindows) {
    constexpr int kRuns = 60;
    Matrix6d reported = Matrix6d::Zero(), seen = Matrix6d::Zero();
    for (unsigned seed = 1; seed <= kRuns; ++seed) {
        see(seed, kShift);
        const auto posterior = refined();
        ASSERT_TRUE(posterior) << seed;
        EXPECT_EQ(posterior->oldest, 1);
        EXPECT_EQ(posterior->reused, 0);
        const Vector6d error = errorTo(truth_.back().T_world_camera);
        reported += posterior->uncertainty.covariance() / kRuns;
        seen += error * error.transpose() / kRuns;
    }
    for (int axis = 0; axis < 6; ++axis) {
        const double ratio = std::sqrt(reported(axis, axis) / seen(axis, axis));
        EXPECT_GT(ratio, 0.65) << axis;
        EXPECT_LT(ratio, 1.5) << axis;
    }
    const double normalised = reported.ldlt().solve(seen).trace() / 6;
    EXPECT_GT(normalised, 0.5);
    EXPECT_LT(normalised, 2);
}

TEST_F(Posterior, FollowsTheOldestKeyframeAsRefiningDoes) {
    see(1, 0);
    const auto posterior = refined();
    ASSERT_TRUE(posterior);
    const Pose newest = window_.back().T_world_camera;
    for (int axis = 0; axis < 6; ++axis) {
        Vector6d step = Vector6d::Zero();
        step[axis] = axis < 3 ? 5e-4 : 3e-4;  // m, rad: a small part of a pixel
        window_ = truth_;
        window_[1].fixed = true;
        const Pose& truth = truth_[1].T_world_camera;
        window_[1].T_world_camera = truth * poseIncrement(step);
        edges_ = fuse(window_, clustersByCurve(made_));
        for (int k = 0; k < 3; ++k) refine(8);
        const Vector6d moved = errorTo(newest), expected = posterior->follows * step;
        EXPECT_LT((moved - expected).norm(), 0.2 * expected.norm()) << axis << "\n"
                                                                    << moved.transpose() << "\n"
                                                                    << expected.transpose();
        EXPECT_GT(expected.norm(), 0.1 * step.norm()) << axis;
    }
}

// Edges move the camera the way that is said, as in tracking: what one does to both adds up with its sign.
TEST_F(Posterior, AnInfluenceIsWhatAnEdgeMovesTheCameraBy) {
    const auto refinedWith = [&](int disturbed) {
        std::vector<TestKeyframe> made;
        for (int k = 0; k < 5; ++k) {
            std::vector<Sighting> sightings = seeAll(curves_);
            if (k == 4 && disturbed >= 0) sightings[static_cast<std::size_t>(disturbed)].shift = {0.1, -0.1};
            made.push_back(makeKeyframe(k, placeOnPath(k), curves_, sightings));
        }
        look(std::move(made));
        window_[1].fixed = true;
        return *refined();
    };
    const auto influenceOf = [](const WindowPosterior& posterior, int cluster) {
        Vector6d sum = Vector6d::Zero();
        for (const EdgeInfluence& edge : posterior.uncertainty.influences)
            if (edge.cluster == cluster) sum += edge.moved;
        return sum;
    };
    const WindowPosterior plain = refinedWith(-1);
    const Pose undisturbed = window_.back().T_world_camera;
    // Metres and radians differ
    const Vector6d scale = Vector6d(plain.uncertainty.covariance().diagonal()).cwiseSqrt();
    for (int edge = 0; edge < static_cast<int>(curves_.size()); edge += 4) {
        const WindowPosterior posterior = refinedWith(edge);
        const Vector6d moved = errorTo(undisturbed).cwiseQuotient(scale);
        const Vector6d said = (influenceOf(posterior, edge) - influenceOf(plain, edge)).cwiseQuotient(scale);
        EXPECT_GT(moved.dot(said), 0.7 * moved.norm() * said.norm()) << edge << "\n"
                                                                     << moved.transpose() << "\n"
                                                                     << said.transpose();
    }
}

TEST_F(Posterior, WhatOnlyAPriorTellsIsAsUncertainAsThat) {
    // Parallel edges say nothing of motions along them
    curves_.clear();
    for (int k = 0; k < 12; ++k) {
        const double y = 0.09 * k - 0.5, z = 2 + 0.3 * (k % 3);
        curves_.push_back(segment({-0.7, y, z}, {0.7, y, z}));
    }
    see(1, 0);
    constexpr double kSigma = 0.03, kWeight = 0.03;
    for (int to = 2; to < 5; ++to) {
        RelativePrior prior;
        prior.from = to - 1;
        prior.to = to;
        prior.T_from_to = truth_[static_cast<std::size_t>(to - 1)].T_world_camera.inverse() *
                          truth_[static_cast<std::size_t>(to)].T_world_camera;
        prior.weight = kWeight;
        prior.information = kWeight / (kSigma * kSigma) * Matrix6d::Identity();
        priors_.push_back(prior);
    }
    const auto posterior = refined();
    ASSERT_TRUE(posterior);
    const Matrix6d covariance = posterior->uncertainty.covariance();
    ASSERT_TRUE(covariance.allFinite());
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), std::sqrt(3.) * kSigma, 0.2 * kSigma) << "three motions";
    EXPECT_LT(std::sqrt(covariance(1, 1)), 0.2 * kSigma) << "across them, edges tell";
}

TEST_F(Posterior, SaysNothingWhereNothingOlderTakesPart) {
    see(1, kShift);
    window_[0].fixed = false;
    window_.front().fixed = true;
    window_[1].fixed = false;
    EXPECT_FALSE(refined()) << "only the window's oldest is fixed";
    see(1, kShift);
    for (WindowKeyframe& view : window_) view.fixed = true;
    EXPECT_FALSE(refined());
    see(1, kShift);
    edges_ = FusedEdges();
    EXPECT_FALSE(refined()) << "no edges";
}

}  // namespace
}  // namespace roevo
