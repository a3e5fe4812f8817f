// Steps of tracking that an experiment overrides: with copies of ROEVO's own nothing changes, and what they
// say counts.
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>

#include "core/support/simulated.h"
#include "tracking/se3.h"
#include "tracking/tracker.h"

namespace roevo {
namespace {

const testing::Sequence& recording() {
    static const testing::Sequence sequence = testing::simulate(testing::smallRoom(), 30);
    return sequence;
}

/// @param tracker  nullptr: ROEVO's own
std::vector<FrameResult> run(const OdometryOptions& options, std::unique_ptr<Tracker> tracker = nullptr) {
    Odometry odometry(recording().camera, options, recording().start(), std::move(tracker));
    std::vector<FrameResult> results;
    for (const RgbdFrame& frame : recording().frames) results.push_back(odometry.processFrame(frame));
    return results;
}

void expectSame(const std::vector<FrameResult>& a, const std::vector<FrameResult>& b,
                double ratio_within = 1e-3) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].status, b[i].status) << i;
        EXPECT_EQ(a[i].new_keyframe, b[i].new_keyframe) << i;
        EXPECT_LT((a[i].T_world_camera.matrix() - b[i].T_world_camera.matrix()).norm(), 1e-9) << i;
        EXPECT_LT((a[i].covariance - b[i].covariance).norm(), 1e-6 * a[i].covariance.norm() + 1e-15) << i;
        EXPECT_NEAR(a[i].matched_ratio, b[i].matched_ratio, ratio_within) << i;
    }
}

/// Refines with a FineTracker of its own.
class OwnRefinement : public Tracker {
  public:
    OwnRefinement(const OdometryOptions& options, int& calls)
        : Tracker(recording().camera, options), fine_(camera_, options_), calls_(calls) {}

  protected:
    FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                      const PosePrior& prior, const RollingShutter& shutter,
                      const Brightness& brightness) override {
        ++calls_;
        EXPECT_EQ(cv::countNonZero(frame.mask.mask), static_cast<int>(frame.mask.pixels.size()));
        return fine_.track(reference, frame, T_start, prior, shutter, brightness);
    }

  private:
    FineTracker fine_;
    int& calls_;
};

TEST(TrackerOverrides, FineTrackingPutInFromOutsideChangesNothing) {
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        OdometryOptions options;
        options.mode = mode;
        int calls = 0;
        // Our own refinement leaves its associations to be assessed; with another one edges are associated
        // anew
        expectSame(run(options), run(options, std::make_unique<OwnRefinement>(options, calls)), 0.005);
        EXPECT_GE(calls, 29);
    }
}

/// Aligns with a CoarseTracker of its own.
class OwnAlignment : public Tracker {
  public:
    OwnAlignment(const OdometryOptions& options, int& calls)
        : Tracker(recording().camera, options), coarse_(options_.coarse), calls_(calls) {}

  protected:
    CoarseResult align(const Keyframe& reference, const Frame& frame, const RollingShutter& shutter,
                       const std::vector<Pose>& guesses, const Brightness& brightness) override {
        ++calls_;
        const int finest = options_.mode == Mode::kCoarse ? 0 : 1;  // as Tracker has it
        return coarse_.track(reference, frame.pyramid, ideal_, shutter, guesses, brightness, finest);
    }

  private:
    CoarseTracker coarse_;
    int& calls_;
};

TEST(TrackerOverrides, CoarseTrackingPutInFromOutsideChangesNothing) {
    for (const Mode mode : {Mode::kCoarse, Mode::kTracking}) {
        OdometryOptions options;
        options.mode = mode;
        int calls = 0;
        expectSame(run(options), run(options, std::make_unique<OwnAlignment>(options, calls)));
        EXPECT_GE(calls, 29);
    }
}

/// Chooses the points itself.
class OwnPoints : public Tracker {
  public:
    explicit OwnPoints(const OdometryOptions& options) : Tracker(recording().camera, options) {}
    PhotometricPoints choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                   const RowMotion&) const override {
        return samplePhotometricPoints(edges, frame.pyramid, options_.coarse.max_points);
    }
};

TEST(TrackerOverrides, PointsPutInFromOutsideChangeNothing) {
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    expectSame(run(options), run(options, std::make_unique<OwnPoints>(options)));
}

/// Returns one and the same thing for every start.
class FixedRefinement : public Tracker {
  public:
    /// @param step  from where refining starts to its result
    FixedRefinement(const OdometryOptions& options, const Vector6d& step, bool converged)
        : Tracker(recording().camera, options), step_(step), converged_(converged) {}

  protected:
    FineResult refine(const Keyframe&, const Frame&, const Pose& T_start, const PosePrior&,
                      const RollingShutter&, const Brightness&) override {
        FineResult result;
        result.T_current_keyframe = poseIncrement(step_) * T_start;
        result.converged = converged_;
        return result;
    }

  private:
    Vector6d step_;
    bool converged_;
};

TEST(TrackerOverrides, ARefinementThatFailsLosesTheFrame) {
    OdometryOptions options;
    options.mode = Mode::kTracking;
    const std::vector<FrameResult> results =
        run(options, std::make_unique<FixedRefinement>(options, Vector6d::Zero(), false));
    EXPECT_EQ(results[1].status, FrameStatus::kPredicted);
    EXPECT_NE(results[1].reason, "");
}

TEST(TrackerOverrides, APoseThatLeavesTheEdgesIsNotTracked) {
    Vector6d away = Vector6d::Zero();
    away[4] = 40 * kDegree;
    OdometryOptions options;
    options.mode = Mode::kTracking;
    const std::vector<FrameResult> results =
        run(options, std::make_unique<FixedRefinement>(options, away, true));
    EXPECT_EQ(results[1].status, FrameStatus::kPredicted);
}

/// Has nothing to align.
class NoPoints : public Tracker {
  public:
    explicit NoPoints(const OdometryOptions& options) : Tracker(recording().camera, options) {}
    PhotometricPoints choosePoints(const EdgePoints3D&, const Frame&, const RowMotion&) const override {
        return {};
    }
};

TEST(TrackerOverrides, WithoutPointsCoarseTrackingSaysSo) {
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    const std::vector<FrameResult> results = run(options, std::make_unique<NoPoints>(options));
    EXPECT_EQ(results[1].status, FrameStatus::kPredicted);
    EXPECT_NE(results[1].reason.find("too few points"), std::string::npos) << results[1].reason;
}

}  // namespace
}  // namespace roevo
