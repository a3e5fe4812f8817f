// The ablation's points (DSO's selection, raw Canny, organized edges) and the two experiments that need an
// odometry of their own, on a small simulated room.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <set>
#include <sstream>

#include "coarse_points.h"
#include "core/support/simulated.h"
#include "point_selection.h"
#include "roevo/edges/canny.h"
#include "roevo/edges/edge_extractor.h"
#include "study.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

/// The first frames of a room, with the noise of a Kinect. Every case is a process of its own: no more than
/// needed.
testing::Sequence room(int frames) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    return testing::simulate(options, frames);
}
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
            const bool square = (x / 12 + y / 12) % 2 == 0, stripe = y / 20 % 2 == 0;
            image.at<std::uint8_t>(y, x) =
                static_cast<std::uint8_t>(x < 160 ? (square ? 220 : 20) : (stripe ? 110 : 130));
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
    extractor.extract(grey, edges);
    cv::Mat raw = cv::Mat::zeros(grey.size(), CV_8UC1);
    for (const cv::Point& p : pixels) raw.at<std::uint8_t>(p) = 1;
    const cv::Mat& adjusted = extractor.mask().mask;
    EXPECT_EQ(cv::countNonZero(adjusted & ~raw & 1), 0) << "organizing only takes pixels away";
    EXPECT_GT(pixels.size(), extractor.mask().pixels.size());
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
    EXPECT_EQ(points.x.size() % kernels::kLanes, 0U);
    EXPECT_EQ(points.weight.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2d seen = camera.project({points.x[i], points.y[i], points.z[i]});
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
                          coarseStages(points, sequence.camera, options));
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
    const RgbdFrame& frame = sequence.frames[0];
    const OdometryOptions options;
    EdgeExtractor extractor(options.edges);
    OrganizedEdges edges;
    extractor.extract(frame.grey, edges);
    const EdgePoints3D lifted =
        liftEdges(edges, frame.depth, sequence.camera, RowMotion(), options.edges, options.sensor);
    ImagePyramid pyramid;
    pyramid.build(frame.grey, 3);
    const RowMotion rows;
    for (const CoarsePoints kind : kAllCoarsePoints) {
        const PhotometricPoints points = coarseStages(kind, sequence.camera, options)
                                             .photometric_points({lifted, pyramid, frame.depth, rows});
        ASSERT_GT(points.size(), 300U);
        EXPECT_LE(static_cast<int>(points.size()), options.coarse.max_points);
        const bool own = kind == CoarsePoints::kOriented;
        EXPECT_EQ(points.turning, own);
        const auto along_x =
            std::count_if(points.axis_x.begin(), points.axis_x.end(), [](float x) { return x == 1; });
        EXPECT_EQ(static_cast<std::size_t>(along_x) == points.size(), !own);
        if (kind != CoarsePoints::kOrganized) continue;
        const PhotometricPoints oriented =
            samplePhotometricPoints(lifted, pyramid, options.coarse.max_points);
        EXPECT_EQ(points.x, oriented.x) << "the same places as with oriented patches";
        EXPECT_EQ(points.weight, oriented.weight);
    }
}

TEST(CoarsePoints, OrientedPatchesAreTheOdometrysOwn) {
    const testing::Sequence sequence = room(12);
    OdometryOptions options;
    options.mode = Mode::kCoarse;
    Odometry own(sequence.camera, options, sequence.start());
    Odometry study(sequence.camera, options, sequence.start(),
                   coarseStages(CoarsePoints::kOriented, sequence.camera, options));
    for (std::size_t i = 0; i < 12; ++i) {
        const Pose a = own.processFrame(sequence.frames[i]).T_world_camera;
        const Pose b = study.processFrame(sequence.frames[i]).T_world_camera;
        EXPECT_EQ((a.matrix() - b.matrix()).norm(), 0) << i;
    }
}

/// The room's frames from memory; the third of them is damaged if so wanted.
class MemorySource : public FrameSource {
  public:
    MemorySource(const testing::Sequence& sequence, bool damaged) : sequence_(sequence), damaged_(damaged) {}
    bool next(SourceFrame& frame) override {
        if (next_ == size()) return false;
        frame = SourceFrame();
        frame.timestamp = sequence_.frames[next_].timestamp;
        if (damaged_ && next_ == 2) {
            frame.fault = "cannot be read";
        } else {
            frame.frame = sequence_.frames[next_];
        }
        ++next_;
        return true;
    }
    bool skip() override { return next_++ < size(); }
    const PinholeCamera& camera() const override { return sequence_.camera; }
    std::string kind() const override { return "memory"; }
    std::string cameraSource() const override { return "simulator"; }
    GroundTruth groundTruth() const override { return {}; }
    std::vector<std::string> notes() const override { return {}; }
    std::size_t size() const override { return sequence_.frames.size(); }
    std::string warning() const override { return {}; }

  private:
    const testing::Sequence& sequence_;
    bool damaged_;
    std::size_t next_ = 0;
};

class StudyFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("roevo_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
                   std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static StudyInput input(const std::string& name, const testing::Sequence& sequence, bool with_truth,
                            bool damaged) {
        StudyInput input;
        input.name = input.path = name;
        input.camera = sequence.camera;
        input.open = [&sequence, damaged] { return std::make_unique<MemorySource>(sequence, damaged); };
        if (with_truth) input.ground_truth = sequence.truth;
        input.ground_truth_note = with_truth ? "simulated" : "no ground truth was found";
        return input;
    }
    /// Rows of a CSV file, split at commas (no field of these files is quoted).
    std::vector<std::vector<std::string>> table(const std::string& name) const {
        std::ifstream in(folder_ / name);
        std::vector<std::vector<std::string>> rows;
        for (std::string line; std::getline(in, line);) {
            std::vector<std::string> fields;
            std::istringstream fields_in(line + ",");
            for (std::string field; std::getline(fields_in, field, ',');) fields.push_back(field);
            rows.push_back(fields);
        }
        return rows;
    }
    fs::path folder_;
};

TEST_F(StudyFolder, AblationWritesEveryWayAndAllTogether) {
    const testing::Sequence sequence = room(34);
    const StudyReport report = studyAblation(
        {input("a", sequence, true, false), input("b", sequence, true, true)}, folder_.string());
    const auto rows = table("ablation.csv");
    ASSERT_EQ(rows.size(), 1U + 2 * 5 * 4 + 4);
    double forward = 0, backward = 0;  // m per frame
    for (std::size_t i = 1; i < rows.size(); ++i) {
        ASSERT_EQ(rows[i].size(), rows[0].size()) << i;
        EXPECT_GT(std::stod(rows[i][5]), 0) << i;
        EXPECT_LT(std::stod(rows[i][5]), 0.01) << "m per frame, row " << i;
        EXPECT_EQ(rows[i][7], rows[i][8]) << "all frames are tracked, row " << i;
        EXPECT_GT(std::stod(rows[i][9]), 300);
        if (rows[i][1] == "backwards") backward += std::stod(rows[i][5]);
        if (rows[i][1] == "forward") {
            forward += std::stod(rows[i][5]);
            EXPECT_GT(std::stod(rows[i][3]), 0);
            EXPECT_LT(std::stod(rows[i][3]), 0.03) << "m/s, row " << i;
            EXPECT_EQ(rows[i][7], rows[i][0] == "a" ? "34" : "33");
        }
    }
    EXPECT_LT(backward, 3 * forward) << "the truth must be turned round with the frames";
    EXPECT_GT(backward, forward / 3);
    EXPECT_NE(report.summary.find("raw Canny"), std::string::npos);
    EXPECT_EQ(report.plot_fault, "");
    EXPECT_TRUE(fs::exists(folder_ / "ablation.svg"));
}

TEST_F(StudyFolder, WithoutGroundTruthAblationSaysSoAndGivesNoError) {
    const testing::Sequence sequence = room(8);
    const StudyReport report = studyAblation({input("a", sequence, false, false)}, folder_.string());
    EXPECT_EQ(report.summary, "no recording with errors over a second");
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("no ground truth was found"), std::string::npos);
    for (const auto& row : table("ablation.csv")) {
        if (row[0] != "a") continue;
        EXPECT_EQ(row[3], "");
        EXPECT_EQ(row[5], "");
    }
}

TEST_F(StudyFolder, EfficiencyTimesBothOnTheSameFrames) {
    const testing::Sequence sequence = room(16);
    const StudyReport report = studyEfficiency({input("a", sequence, false, true)}, folder_.string());
    const auto rows = table("efficiency.csv");
    ASSERT_EQ(rows.size(), 1U + 12 + 2);
    double ours = 0, theirs = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        EXPECT_GT(std::stod(rows[i][5]), 0) << rows[i][1] << ' ' << rows[i][2];
        EXPECT_LT(std::stod(rows[i][5]), 1000);
        if (rows[i][2] == "sum" || rows[i][2] == "whole frame" || rows[i][1] == "ROEVO local mapping")
            continue;
        EXPECT_EQ(rows[i][6], "14") << "15 frames could be read, the first is the keyframe";
        if (rows[i][1] == "ROEVO") ours += std::stod(rows[i][5]);
        if (rows[i][1] == "distance field" && rows[i][2].find("5x5") == std::string::npos)
            theirs += std::stod(rows[i][5]);
    }
    for (const auto& row : rows) {
        if (row[2] != "sum") continue;
        const double sum = row[1] == "ROEVO" ? ours : theirs;
        EXPECT_NEAR(std::stod(row[5]), sum, 0.01 * sum) << "means add up";
    }
    EXPECT_TRUE(fs::exists(folder_ / "efficiency.svg"));
    EXPECT_EQ(report.plot_fault, "");
}

}  // namespace
}  // namespace roevo
