// The 6x6 system: assembling, solving, the prior; and the loop that minimises.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "core/support/random_pose.h"
#include "tracking/gauss_newton.h"

namespace roevo {
namespace {

kernels::NormalEquations fromMatrix(const Matrix6d& hessian, const Vector6d& gradient) {
    kernels::NormalEquations part{};
    int k = 0;
    for (int r = 0; r < 6; ++r) {
        part.gradient[r] = gradient[r];
        for (int c = r; c < 6; ++c) part.hessian[k++] = hessian(r, c);
    }
    return part;
}

TEST(PoseSystem, AddUnpacksTheUpperTriangleAndSums) {
    std::mt19937 random(71);
    Matrix6d hessian = Matrix6d::Zero();
    PoseSystem system;
    for (int i = 0; i < 3; ++i) {
        const Matrix6d a = Matrix6d::Random();
        const Matrix6d part = a + a.transpose();
        system.add(fromMatrix(part, Vector6d::Constant(i)));
        hessian += part;
    }
    EXPECT_LT((system.hessian - hessian).norm(), 1e-12);
    EXPECT_LT((system.gradient - Vector6d::Constant(3)).norm(), 1e-12);
}

TEST(PoseSystem, SolvesForTheMinusGradient) {
    const Matrix6d a = Matrix6d::Random();
    PoseSystem system;
    system.hessian = a * a.transpose() + Matrix6d::Identity();
    system.gradient = Vector6d::Random();
    EXPECT_LT((system.hessian * system.solve() + system.gradient).norm(), 1e-9);
}

TEST(PoseSystem, SingularGivesNoStepAndNoNan) {
    PoseSystem empty;
    EXPECT_EQ(empty.solve().norm(), 0);
    empty.gradient.setOnes();
    EXPECT_EQ(empty.solve().norm(), 0);

    PoseSystem line;  // only one direction is seen
    line.hessian(2, 2) = 100;
    line.gradient[2] = 50;
    const Vector6d step = line.solve();
    EXPECT_TRUE(step.allFinite());
    EXPECT_LT(step.norm(), 0.5 + 1e-9);

    PoseSystem broken;
    broken.hessian.setIdentity();
    broken.hessian(1, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(broken.solve().norm(), 0);
    broken.hessian.setIdentity();
    broken.gradient[0] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(broken.solve().norm(), 0);
    PoseSystem negative;
    negative.hessian = -Matrix6d::Identity();
    negative.gradient.setOnes();
    EXPECT_EQ(negative.solve().norm(), 0);
}

/// Sigmas in m and rad.
PosePrior priorOf(const Pose& mean, double position, double orientation, double weight = 1) {
    Vector6d variance;
    variance << Eigen::Vector3d::Constant(position * position),
        Eigen::Vector3d::Constant(orientation * orientation);
    return {mean, variance.asDiagonal(), weight, {}};
}

TEST(PosePrior, AloneItBringsThePoseToItsMean) {
    std::mt19937 random(72);
    for (int i = 0; i < 50; ++i) {
        const PosePrior prior = priorOf(testing::randomPose(random, 1, 0.5), 0.01, 0.02);
        Pose pose = testing::randomPose(random, 0.2, 0.2) * prior.mean;
        for (int step = 0; step < 5; ++step) {
            PoseSystem system;
            ASSERT_TRUE(PriorTerm(prior).linearise({pose, RowMotion(), 0}, system));
            pose = poseIncrement(system.solve()) * pose;
        }
        EXPECT_LT((pose.matrix() - prior.mean.matrix()).norm(), 1e-9);
    }
}

TEST(PosePrior, PullsOnlyWhereNothingElseDecides) {
    PoseSystem system;
    for (int k = 0; k < 5; ++k)
        system.hessian(k, k) = 1e9;  // five directions are seen well and are satisfied
    const PosePrior prior = priorOf(Pose::Identity(), 0.05, 0.05);
    Vector6d off = Vector6d::Constant(0.01);
    ASSERT_TRUE(PriorTerm(prior).linearise({poseIncrement(off), RowMotion(), 0}, system));
    const Vector6d step = system.solve();
    EXPECT_LT(step.head<5>().norm(), 1e-7);
    EXPECT_NEAR(step[5], -0.01, 1e-4);
}

TEST(PosePrior, WeighsByItsSigmasAndItsWeight) {
    const PosePrior prior = priorOf(Pose::Identity(), 0.1, 0.2, 5);
    PoseSystem system;
    ASSERT_TRUE(PriorTerm(prior).linearise({Pose::Identity(), RowMotion(), 0}, system));
    EXPECT_NEAR(system.hessian(0, 0), 500, 1e-9);
    EXPECT_NEAR(system.hessian(5, 5), 125, 1e-9);
    EXPECT_LT(system.gradient.norm(), 1e-12);
}

TEST(DampingTerm, HoldsStepsBackFromWhereverThePoseIs) {
    std::mt19937 random(73);
    PoseSystem system;
    DampingTerm damping(0.1, 0.2);
    ASSERT_TRUE(damping.linearise({testing::randomPose(random, 1, 1), RowMotion(), 0}, system));
    EXPECT_NEAR(system.hessian(0, 0), 100, 1e-9);
    EXPECT_NEAR(system.hessian(5, 5), 25, 1e-9);
    EXPECT_EQ(system.gradient.norm(), 0);
}

/// Goes 10 cm along x in every step, and says what it is told to of how good that is.
class Walk : public ResidualTerm {
  public:
    /// @param costs  of the linearisations, in order; the last one for all that follow
    explicit Walk(std::vector<double> costs = {0}) : costs_(std::move(costs)) {}

    bool linearise(const Linearisation& at, PoseSystem& system) override {
        EXPECT_EQ(at.iteration, static_cast<int>(places.size()));
        places.push_back(at.T_current_keyframe.translation().x());
        system.hessian += Matrix6d::Identity();
        system.gradient[0] -= 0.1;
        return static_cast<int>(places.size()) <= most;
    }
    double cost() const override { return costs_[std::min(places.size(), costs_.size()) - 1]; }
    void keep() override { kept.push_back(places.back()); }
    void update() override { ++updates; }

    int most = 1000;             ///< linearisations that it does not give up at
    std::vector<double> places;  ///< x of the poses, m
    std::vector<double> kept;
    int updates = 0;

  private:
    std::vector<double> costs_;
};

GaussNewtonOptions steps(int count) {
    GaussNewtonOptions options;
    options.max_iterations = count;
    return options;
}

double placeOf(const GaussNewtonResult& result) {
    return result.T_current_keyframe.translation().x();
}

TEST(Minimise, TheLastPoseCountsUnlessTheBestIsAskedFor) {
    Walk walk({10, 5, 20, 1});
    const GaussNewtonResult result = minimise(Pose::Identity(), RollingShutter(), {&walk}, steps(3));
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.iterations, 3);
    EXPECT_EQ(walk.updates, 3);
    EXPECT_NEAR(placeOf(result), 0.3, 1e-12);
}

TEST(Minimise, KeepsTheBestPoseAndStopsWhereTheCostDiverges) {
    Walk walk({10, 5, 20, 1});
    GaussNewtonOptions options = steps(10);
    options.keep_best = true;
    const GaussNewtonResult result = minimise(Pose::Identity(), RollingShutter(), {&walk}, options);
    EXPECT_EQ(walk.places.size(), 3U) << "20 after 5 is no way to go on";
    EXPECT_TRUE(result.complete) << "no term gave up";
    EXPECT_NEAR(placeOf(result), 0.1, 1e-12);
    EXPECT_EQ(result.cost, 5);
    ASSERT_EQ(walk.kept.size(), 2U);
    EXPECT_NEAR(walk.kept.back(), 0.1, 1e-12) << "what the term estimates belongs to the same pose";
}

TEST(Minimise, ALittleWorseIsGoneThroughButNotKept) {
    Walk walk({10, 11, 4, 4.5, 4.6});
    GaussNewtonOptions options = steps(5);
    options.keep_best = true;
    const GaussNewtonResult result = minimise(Pose::Identity(), RollingShutter(), {&walk}, options);
    EXPECT_EQ(result.iterations, 5);
    EXPECT_NEAR(placeOf(result), 0.2, 1e-12);
    EXPECT_EQ(result.cost, 4);
}

TEST(Minimise, ATermThatGivesUpEndsIt) {
    for (const bool first : {true, false}) {
        Walk walk, other;
        (first ? walk : other).most = 2;
        const GaussNewtonResult result =
            minimise(Pose::Identity(), RollingShutter(), {&walk, &other}, steps(10));
        EXPECT_FALSE(result.complete);
        EXPECT_EQ(result.iterations, 2);
        EXPECT_NEAR(placeOf(result), 0.2, 1e-12) << "as far as it came";
    }
    Walk none;
    none.most = 0;
    for (const bool keep_best : {true, false}) {
        Pose start = Pose::Identity();
        start.translation().x() = 7;
        GaussNewtonOptions options = steps(10);
        options.keep_best = keep_best;
        none.places.clear();
        const GaussNewtonResult result = minimise(start, RollingShutter(), {&none}, options);
        EXPECT_FALSE(result.complete);
        EXPECT_EQ(result.iterations, 0);
        EXPECT_LT(result.cost, 0) << "nothing could be linearised";
        EXPECT_EQ(placeOf(result), 7);
    }
}

TEST(Minimise, LongerStepsBeginWhereTheyMay) {
    Walk walk;
    GaussNewtonOptions options = steps(3);
    options.relaxation = 1.5;
    options.relaxed_from = 1;
    EXPECT_NEAR(placeOf(minimise(Pose::Identity(), RollingShutter(), {&walk}, options)), 0.1 + 2 * 0.15,
                1e-12);
}

TEST(Minimise, ASmallStepEndsItOnceItIsSettled) {
    GaussNewtonOptions options = steps(20);
    options.focal_length = 500;
    options.depth = 2;
    for (const int settled : {1, 4}) {
        options.settled_from = settled;
        PriorTerm place(priorOf(poseIncrement(Vector6d::Constant(0.01)), 1, 1));  // reached in one step
        const GaussNewtonResult result = minimise(Pose::Identity(), RollingShutter(), {&place}, options);
        EXPECT_EQ(result.iterations, settled + 1);
        EXPECT_TRUE(result.complete);
    }
    Walk walk;  // 25 px in every step
    EXPECT_EQ(minimise(Pose::Identity(), RollingShutter(), {&walk}, options).iterations, 20);
}

TEST(Minimise, RowsMoveAsTheShutterSaysOfThePose) {
    class Rows : public ResidualTerm {
      public:
        bool linearise(const Linearisation& at, PoseSystem& system) override {
            system.hessian.setIdentity();
            system.gradient[0] = -0.01;
            speeds.push_back(at.rows.velocity.x());
            EXPECT_EQ(at.rows.seconds_per_row, 1e-5);
            return true;
        }
        std::vector<double> speeds;
    } rows;
    RollingShutter shutter;
    shutter.rows.seconds_per_row = 1e-5;
    shutter.since_previous = 0.1;
    const GaussNewtonResult result = minimise(Pose::Identity(), shutter, {&rows}, steps(2));
    ASSERT_EQ(rows.speeds.size(), 2U);
    EXPECT_NEAR(rows.speeds[0], 0, 1e-12);
    EXPECT_NEAR(rows.speeds[1], -0.1, 1e-12) << "the camera goes the other way than its keyframe";
    EXPECT_EQ(result.seconds_per_row, 1e-5);
}

/// Residuals that are linear in the pose and the read-out time.
class LinearInBoth : public ResidualTerm {
  public:
    LinearInBoth(const Vector6d& pose, double seconds_per_row)
        : pose_(pose), seconds_per_row_(seconds_per_row) {
        std::mt19937 random(74);
        for (int i = 0; i < 200; ++i) {
            Vector6d row;
            for (int k = 0; k < 6; ++k) row[k] = testing::uniform(random, -500, 500);
            by_pose_.push_back(row);
            by_readout_.push_back(testing::uniform(random, -1e5, 1e5));
        }
    }
    bool linearise(const Linearisation& at, PoseSystem& system) override {
        const Eigen::AngleAxisd turn(at.T_current_keyframe.linear());
        Vector6d off;
        off << at.T_current_keyframe.translation(), turn.angle() * turn.axis();
        off -= pose_;
        for (std::size_t i = 0; i < by_pose_.size(); ++i) {
            const double residual =
                by_pose_[i].dot(off) + by_readout_[i] * (at.rows.seconds_per_row - seconds_per_row_);
            system.hessian += by_pose_[i] * by_pose_[i].transpose();
            system.gradient += residual * by_pose_[i];
            system.readout_mixed += by_readout_[i] * by_pose_[i];
            system.readout_hessian += by_readout_[i] * by_readout_[i];
            system.readout_gradient += by_readout_[i] * residual;
        }
        return true;
    }

  private:
    Vector6d pose_;
    double seconds_per_row_;
    std::vector<Vector6d> by_pose_;
    std::vector<double> by_readout_;
};

TEST(Minimise, AFreeReadoutTimeIsFoundAlongWithThePose) {
    Vector6d pose;
    pose << 0.02, -0.01, 0.03, 0.01, -0.02, 0.005;
    constexpr double kReadout = 3e-5;  // s per row
    LinearInBoth term(pose, kReadout);
    RollingShutter shutter;
    shutter.rows.seconds_per_row = 1e-5;
    GaussNewtonOptions options = steps(15);
    options.still = 0;
    options.free_readout = true;
    const GaussNewtonResult found = minimise(Pose::Identity(), shutter, {&term}, options);
    EXPECT_TRUE(found.complete);
    EXPECT_NEAR(found.seconds_per_row, kReadout, 1e-6 * kReadout);
    EXPECT_LT((found.T_current_keyframe.matrix() - poseIncrement(pose).matrix()).norm(), 1e-8);
    // Where it is not free it stays, and the pose is off for it
    options.free_readout = false;
    const GaussNewtonResult held = minimise(Pose::Identity(), shutter, {&term}, options);
    EXPECT_EQ(held.seconds_per_row, shutter.rows.seconds_per_row);
    EXPECT_GT((held.T_current_keyframe.matrix() - poseIncrement(pose).matrix()).norm(), 1e-6);
}

}  // namespace
}  // namespace roevo
