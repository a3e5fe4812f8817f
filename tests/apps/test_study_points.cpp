// The points that the ablation gives to coarse tracking: DSO's selection, raw Canny, organized edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <set>

#include "apps/study_fixture.h"
#include "coarse_points.h"
#include "edges/canny.h"
#include "edges/edge_extractor.h"
#include "point_selection.h"

namespace roevo {
namespace {

using test::room;

cv::Mat oneImage() {
    return room(1).frames[0].grey;
}

Gradient gradientOf(const cv::Mat& grey) {
    Gradient gradient;
    computeGradient(grey, 0, gradient);
    return gradient;
}

TEST(PointSelection, DsoGivesAsManyAsAreWantedWhereThereAreEnough) {
    const Gradient gradient = gradientOf(oneImage());
    for (const int wanted : {100, 400, 1000}) {
        const auto pixels = selectDsoPixels(gradient, wanted);
        EXPECT_LE(static_cast<int>(pixels.size()), wanted);
        EXPECT_GE(static_cast<int>(pixels.size()), wanted * 7 / 10);
    }
}

TEST(PointSelection, DsoSpreadsOverTheImageAndCannyDoesNot) {
    // Strong squares on the left, faint stripes on the right: DSO's thresholds follow the region
    cv::Mat image(240, 320, CV_8UC1);
    for (int y = 0; y < image.rows; ++y) {
        for (int x = 0; x < image.cols; ++x) {
            const int square = (x / 6 + y / 6) % 2 == 0 ? 220 : 20, stripe = y / 20 % 2 == 0 ? 110 : 130;
            const int apart = 120;  // else a stripe is one edge with the square that it meets
            image.at<std::uint8_t>(y, x) =
                static_cast<std::uint8_t>(x < 160 ? square : (x < 176 ? apart : stripe));
        }
    }
    const Gradient gradient = gradientOf(image);
    const auto shareOnTheRight = [](const std::vector<cv::Point>& pixels) {
        const auto right =
            std::count_if(pixels.begin(), pixels.end(), [](const cv::Point& p) { return p.x > 165; });
        return static_cast<double>(right) / static_cast<double>(pixels.size());
    };
    EXPECT_GT(shareOnTheRight(selectDsoPixels(gradient, 400)), 0.25);
    EXPECT_LT(shareOnTheRight(selectCannyPixels(gradient, EdgeOptions())), 0.05);
}

TEST(PointSelection, DsoTakesAtMostOnePixelOfABlockAndTheStrongestOne) {
    cv::Mat image = cv::Mat::zeros(240, 320, CV_8UC1);
    image(cv::Rect(98, 0, 222, 240)) = 20;  // one vertical edge, steepest at 98
    image(cv::Rect(99, 0, 221, 240)) = 90;
    image(cv::Rect(100, 0, 220, 240)) = 100;
    const Gradient gradient = gradientOf(image);
    const auto pixels = selectDsoPixels(gradient, 20);
    ASSERT_GT(pixels.size(), 5U);
    ASSERT_LE(pixels.size(), 20U);
    std::set<int> rows;
    for (const cv::Point& p : pixels) {
        EXPECT_EQ(p.x, 98);
        rows.insert(p.y);
    }
    EXPECT_EQ(rows.size(), pixels.size());
    std::vector<int> sorted(rows.begin(), rows.end());
    int widest = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) widest = std::max(widest, sorted[i] - sorted[i - 1]);
    EXPECT_LE(widest, 2 * 240 / 10) << "the whole step is covered";
}

TEST(PointSelection, WeakPixelsAreTakenOnlyWhereThereIsNothingStronger) {
    // A step of 20 grey levels has a gradient of 10 per pixel, one of 12 has 6: below 7, above 9/16 of it
    const auto withStep = [](int height) {
        cv::Mat image(240, 320, CV_8UC1, cv::Scalar(50));
        image(cv::Rect(100, 0, 220, 240)) = 50 + height;
        return gradientOf(image);
    };
    const std::size_t strong = selectDsoPixels(withStep(20), 1000).size();
    const std::size_t weak = selectDsoPixels(withStep(12), 1000).size();
    const std::size_t weaker = selectDsoPixels(withStep(9), 1000).size();
    const std::size_t none = selectDsoPixels(withStep(7), 1000).size();
    EXPECT_GT(strong, weak);
    EXPECT_GT(weak, weaker);
    EXPECT_GT(weaker, 0U);
    EXPECT_EQ(none, 0U);
}

TEST(PointSelection, WhatIsNoSteeperThanItsRegionIsNotTaken) {
    cv::Mat image(240, 320, CV_8UC1);
    for (int x = 0; x < image.cols; ++x) {
        const int phase = x % 48;  // up and down by 9 grey levels per pixel
        image.col(x) = 20 + 9 * (phase < 24 ? phase : 48 - phase);
    }
    EXPECT_TRUE(selectDsoPixels(gradientOf(image), 1000).empty());
    image(cv::Rect(0, 100, 320, 140)) = 128;
    EXPECT_GT(selectDsoPixels(gradientOf(image), 1000).size(), 10U) << "the border of the texture stands out";
}

TEST(PointSelection, FlatAndTinyImagesGiveNothing) {
    const Gradient flat = gradientOf(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)));
    EXPECT_TRUE(selectDsoPixels(flat, 500).empty());
    EXPECT_TRUE(selectCannyPixels(flat, EdgeOptions()).empty());
    cv::Mat tiny(7, 6, CV_8UC1);
    cv::randu(tiny, 0, 255);
    EXPECT_TRUE(selectDsoPixels(gradientOf(tiny), 500).empty());
}

TEST(PointSelection, IsTheSameEveryTimeAndKeepsOffTheBorder) {
    const Gradient gradient = gradientOf(oneImage());
    const auto once = selectDsoPixels(gradient, 700), again = selectDsoPixels(gradient, 700);
    EXPECT_EQ(once, again);
    for (const auto& pixels : {once, selectCannyPixels(gradient, EdgeOptions())}) {
        std::set<std::pair<int, int>> different;
        for (const cv::Point& p : pixels) {
            different.insert({p.x, p.y});
            EXPECT_GE(p.x, EdgeMask::kBorder);
            EXPECT_GE(p.y, EdgeMask::kBorder);
            EXPECT_LT(p.x, 320 - EdgeMask::kBorder);
            EXPECT_LT(p.y, 240 - EdgeMask::kBorder);
        }
        EXPECT_EQ(different.size(), pixels.size());
    }
}

TEST(PointSelection, CannyIsWhatTheExtractorSeesBeforeItOrganizes) {
    const cv::Mat grey = oneImage();
    const auto pixels = selectCannyPixels(gradientOf(grey), EdgeOptions());
    EdgeExtractor extractor{EdgeOptions()};
    OrganizedEdges edges;
    EdgeMask mask;
    extractor.extract(grey, edges, mask);
    cv::Mat raw = cv::Mat::zeros(grey.size(), CV_8UC1);
    for (const cv::Point& p : pixels) raw.at<std::uint8_t>(p) = 1;
    const cv::Mat& adjusted = mask.mask;
    EXPECT_EQ(cv::countNonZero(adjusted & ~raw & 1), 0) << "organizing only takes pixels away";
    EXPECT_GT(pixels.size(), mask.pixels.size());
    EXPECT_TRUE(std::is_sorted(pixels.begin(), pixels.end(), [](const cv::Point& a, const cv::Point& b) {
        return std::make_pair(a.y, a.x) < std::make_pair(b.y, b.x);
    }));
}

TEST(PointSelection, PixelsAreLiftedToWhereTheyAre) {
    const testing::Sequence sequence = room(1);
    const RgbdFrame& frame = sequence.frames[0];
    const PinholeCamera& camera = sequence.camera;
    const OdometryOptions options;
    const Gradient gradient = gradientOf(frame.grey);
    const auto pixels = selectDsoPixels(gradient, 500);
    const EdgePoints3D points =
        liftPixels(pixels, gradient, frame.depth, camera, RowMotion(), options.edges, options.sensor);
    ASSERT_GT(points.size(), 200U);
    EXPECT_LE(points.size(), pixels.size());
    EXPECT_EQ(points.points.x.size() % kernels::kLanes, 0U);
    EXPECT_EQ(points.weight.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2d seen = camera.project(points.points.at(i));
        EXPECT_NEAR(seen.x(), points.image.x[i], 1e-3);
        EXPECT_NEAR(seen.y(), points.image.y[i], 1e-3);
        EXPECT_EQ(points.image.gradient_x[i], 1);
    }
}

TEST(CoarsePoints, AllTrackASmallSequence) {
    const testing::Sequence sequence = room(30);
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    for (const CoarsePoints points : kAllCoarsePoints) {
        Odometry odometry(sequence.camera, options, sequence.start(),
                          std::make_unique<CoarsePointsTracker>(points, sequence.camera, options));
        testing::TrackedRun run;
        for (const RgbdFrame& frame : sequence.frames) run.results.push_back(odometry.processFrame(frame));
        EXPECT_EQ(run.count(FrameStatus::kOk), 29) << label(points);
        const double error = testing::positionError(run, sequence);
        RecordProperty(std::string("mm_") + std::to_string(static_cast<int>(points)),
                       std::to_string(1000 * error));
        EXPECT_LT(error, 0.006) << label(points);
    }
}

TEST(CoarsePoints, OnlyOrientedPatchesTurnWithTheCamera) {
    const testing::Sequence sequence = room(1);
    const OdometryOptions options;
    Frame frame;
    frame.images = sequence.frames[0];
    EdgeExtractor(options.edges).extract(frame.images.grey, frame.edges, frame.mask);
    const EdgePoints3D lifted = liftEdges(frame.edges, frame.images.depth, sequence.camera, RowMotion(),
                                          options.edges, options.sensor);
    frame.pyramid.build(frame.images.grey, 3);
    const RowMotion rows;
    for (const CoarsePoints kind : kAllCoarsePoints) {
        const PhotometricPoints points =
            CoarsePointsTracker(kind, sequence.camera, options).choosePoints(lifted, frame, rows);
        ASSERT_GT(points.size(), 300U);
        EXPECT_LE(static_cast<int>(points.size()), options.coarse.max_points);
        const bool own = kind == CoarsePoints::kOriented;
        EXPECT_EQ(points.turning, own);
        const auto along_x =
            std::count_if(points.axis_x.begin(), points.axis_x.end(), [](float x) { return x == 1; });
        EXPECT_EQ(static_cast<std::size_t>(along_x) == points.size(), !own);
        if (kind != CoarsePoints::kOrganized) continue;
        const PhotometricPoints oriented =
            samplePhotometricPoints(lifted, frame.pyramid, options.coarse.max_points);
        EXPECT_EQ(points.points.x, oriented.points.x) << "the same places as with oriented patches";
        EXPECT_EQ(points.weight, oriented.weight);
    }
}

TEST(CoarsePoints, OrientedPatchesAreTheOdometrysOwn) {
    const testing::Sequence sequence = room(12);
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    Odometry own(sequence.camera, options, sequence.start());
    Odometry study(sequence.camera, options, sequence.start(),
                   std::make_unique<CoarsePointsTracker>(CoarsePoints::kOriented, sequence.camera, options));
    for (std::size_t i = 0; i < 12; ++i) {
        const Pose a = own.processFrame(sequence.frames[i]).T_world_camera;
        const Pose b = study.processFrame(sequence.frames[i]).T_world_camera;
        EXPECT_EQ((a.matrix() - b.matrix()).norm(), 0) << i;
    }
}

}  // namespace
}  // namespace roevo
