// Real clips: the accuracy that is promised with the one default configuration. Skips, visibly, without the
// data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "core/support/real_clip.h"
#include "core/support/sparse_depth.h"
#include "evaluation/evaluate.h"
#include "roevo/odometry.h"

namespace roevo {
namespace {

struct Clip {
    const char* name;
    double limit;         ///< m, ATE RMSE in mode tr
    double mapped_limit;  ///< the same in mode ba
};
std::ostream& operator<<(std::ostream& out, const Clip& clip) {
    return out << clip.name;
}

class RealClip : public ::testing::TestWithParam<Clip> {
  protected:
    void SetUp() override {
        if (!clip_)
            GTEST_SKIP() << "no clip " << GetParam().name
                         << "; set ROEVO_DATA_DIR to the folder with the clips";
    }

    /// ATE RMSE, m; every frame must be tracked.
    double ate(Mode mode) {
        OdometryOptions options;
        options.mode = mode;
        Odometry odometry(clip_->camera, options);
        for (std::size_t i = 0; i < clip_->frames.size(); ++i) {
            const FrameResult result = odometry.processFrame(clip_->frames[i]);
            EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk)
                << "frame " << i << ": " << result.reason;
        }
        return evaluate(clip_->truth, odometry.trajectory()).ate.translation.rmse;
    }

  private:
    std::optional<testing::RealFrames> clip_ = testing::realClip(GetParam().name, 150);
};

TEST_P(RealClip, IsTrackedAsWellAsPromised) {
    const double fine = ate(Mode::kTracking), coarse = ate(Mode::kCoarse);
    RecordProperty("tr_cm", std::to_string(100 * fine));
    RecordProperty("ct_cm", std::to_string(100 * coarse));
    EXPECT_LE(fine, GetParam().limit);
    const double mapped = ate(Mode::kBundleAdjustment);
    RecordProperty("ba_cm", std::to_string(100 * mapped));
    EXPECT_LE(mapped, GetParam().mapped_limit);
    EXPECT_LE(fine, coarse) << "fine tracking must not be worse than coarse tracking alone";
}

// What was given in pixels held for 640x480 only: enlarged twice and three times, fr1_xyz went from 0.41 to
// 0.77 and 4.3 cm.
class EnlargedClip : public ::testing::TestWithParam<int> {};

TEST_P(EnlargedClip, IsTrackedAboutAsWell) {
    constexpr std::size_t kAll = 150;
    const auto clip = testing::realClip("tum_fr1_xyz_150", kAll);
    if (!clip) GTEST_SKIP() << "no clip tum_fr1_xyz_150";
    Odometry odometry(testing::enlarged(clip->camera, GetParam()), OdometryOptions());
    for (const RgbdFrame& frame : clip->frames) {
        const FrameResult result = odometry.processFrame(testing::enlarged(frame, GetParam()));
        EXPECT_TRUE(result.status == FrameStatus::kOk || result.status == FrameStatus::kInitialised)
            << result.reason;
    }
    const double rmse = evaluate(clip->truth, odometry.trajectory()).ate.translation.rmse;
    RecordProperty("ba_cm", std::to_string(100 * rmse));
    EXPECT_LE(rmse, GetParam() == 2 ? 0.005 : 0.0055);
}

INSTANTIATE_TEST_SUITE_P(Times, EnlargedClip, ::testing::Values(2, 3));

INSTANTIATE_TEST_SUITE_P(Clips, RealClip,
                         ::testing::Values(Clip{"tum_fr1_xyz_150", 0.011, 0.0095},
                                           Clip{"tum_fr1_rpy_100", 0.010, 0.0075},
                                           Clip{"tum_fr3_structure_notexture_far_80", 0.016, 0.012},
                                           Clip{"icl_office_kt0_50", 0.009, 0.006}),
                         [](const auto& info) { return std::string(info.param.name); });

// Of every n-th pixel of every n-th row. With squares of one size for all, 26, 5.7, lost and 8.5 cm of every
// fourth, mostly without a word.
class SparseDepth : public ::testing::TestWithParam<const char*> {};

TEST_P(SparseDepth, IsAboutAsGoodAsDense) {
    const auto clip = testing::realClip(GetParam(), 150);
    if (!clip) GTEST_SKIP() << "no clip " << GetParam();
    for (const int n : {4, 8}) {
        Odometry odometry(clip->camera, OdometryOptions());
        for (RgbdFrame frame : clip->frames) {
            frame.depth = testing::everyNth(frame.depth, n, n / 2);
            const FrameResult result = odometry.processFrame(frame);
            EXPECT_TRUE(result.status == FrameStatus::kOk || result.status == FrameStatus::kInitialised)
                << result.reason;
        }
        (void)odometry.refineAll();
        const double rmse = evaluate(clip->truth, odometry.trajectory()).ate.translation.rmse;
        RecordProperty("ba_cm_" + std::to_string(n), std::to_string(100 * rmse));
        EXPECT_LE(rmse, n == 4 ? 0.007 : 0.009) << n;
    }
}

INSTANTIATE_TEST_SUITE_P(Clips, SparseDepth,
                         ::testing::Values("tum_fr1_xyz_150", "tum_fr1_rpy_100",
                                           "tum_fr3_structure_notexture_far_80", "icl_office_kt0_50"),
                         [](const auto& info) { return std::string(info.param); });

// With depth in the upper three quarters only, hardly anything but upright edges has depth, and they do not
// tell how high the camera is. What tracking knew of that was taken to grow with every frame of the same
// keyframe, to 2 mm; the prior followed, and the camera drifted by 15 cm (ATE 3.4 cm in tr, 4.5 in ba).
TEST(FewEdges, WhatTheyDoNotTellIsNeitherKnownNorLost) {
    const auto clip = testing::realClip("tum_fr3_structure_notexture_far_80", 80);
    if (!clip) GTEST_SKIP() << "no clip tum_fr3_structure_notexture_far_80";
    const auto truthAt = [&](double time) {
        return std::min_element(clip->truth.begin(), clip->truth.end(),
                                [&](const StampedPose& a, const StampedPose& b) {
                                    return std::abs(a.timestamp - time) < std::abs(b.timestamp - time);
                                })
            ->T_world_camera;
    };
    const Pose T_start_truth = truthAt(clip->frames.front().timestamp).inverse();
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        OdometryOptions options;
        options.mode = mode;
        Odometry odometry(clip->camera, options);
        double nees = 0;
        for (std::size_t i = 0; i < clip->frames.size(); ++i) {
            RgbdFrame frame = clip->frames[i];
            frame.depth = frame.depth.clone();
            frame.depth.rowRange(360, frame.depth.rows).setTo(0);
            const FrameResult result = odometry.processFrame(frame);
            ASSERT_TRUE(result.hasPose()) << i << ": " << result.reason;
            if (i == 0) continue;
            const Eigen::Vector3d error = result.T_world_camera.translation() -
                                          (T_start_truth * truthAt(frame.timestamp)).translation();
            const Eigen::Matrix3d covariance =
                result.covariance.topLeftCorner<3, 3>() + 1e-6 * Eigen::Matrix3d::Identity();
            nees += error.dot(covariance.inverse() * error) / 3;
        }
        EXPECT_LE(evaluate(clip->truth, odometry.trajectory()).ate.translation.rmse, 0.02);
        nees /= static_cast<double>(clip->frames.size() - 1);
        EXPECT_LE(nees, 4);
        EXPECT_GE(nees, 0.05) << "and no less is known than that";
    }
}

// The same desk, recorded twice, minutes apart; motion capture knows both in one frame.
class TwoRecordings : public ::testing::TestWithParam<Mode> {};

TEST_P(TwoRecordings, OfADeskAreOneMap) {
    OdometryOptions options;
    options.mode = GetParam();
    // Where the second one is found, one frame decides: the median of three
    std::vector<double> ates;
    for (const std::size_t start : {0, 3, 6}) {
        std::unique_ptr<Odometry> odometry;
        std::vector<StampedPose> truth;
        for (const char* name : {"tum_fr1_xyz_150", "tum_fr1_rpy_100"}) {
            const auto clip = testing::realClip(name, 150);
            if (!clip) GTEST_SKIP() << "no clip " << name;
            truth.insert(truth.end(), clip->truth.begin(), clip->truth.end());
            const std::size_t from = odometry ? start : 0;
            if (!odometry) odometry = std::make_unique<Odometry>(clip->camera, options);
            for (std::size_t i = from; i < clip->frames.size(); ++i)
                (void)odometry->processFrame(clip->frames[i]);
        }
        ates.push_back(evaluate(truth, odometry->trajectory()).ate.translation.rmse);
    }
    EXPECT_LT(ates[0], GetParam() == Mode::kBundleAdjustment ? 0.008 : 0.016);
    std::sort(ates.begin(), ates.end());
    RecordProperty("cm", std::to_string(100 * ates[1]));
    EXPECT_LT(ates[1], GetParam() == Mode::kBundleAdjustment ? 0.008 : 0.013);
}

INSTANTIATE_TEST_SUITE_P(Modes, TwoRecordings, ::testing::Values(Mode::kTracking, Mode::kBundleAdjustment));

}  // namespace
}  // namespace roevo
