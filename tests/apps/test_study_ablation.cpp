// The ablation of coarse tracking, on a small simulated room.
#include <gtest/gtest.h>

#include <cmath>

#include "ablation_pieces.h"
#include "apps/study_fixture.h"

namespace roevo {
namespace {

using test::room;
using StudyAblation = test::StudyFolder;

TEST_F(StudyAblation, AblationWritesEveryWayAndAllTogether) {
    const testing::Sequence sequence = room(34);
    const StudyReport report =
        studyAblation({input("a", sequence, true, false), input("b", sequence, true, true)}, folder());
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
    EXPECT_TRUE(exists("ablation.svg"));
}

// One variant loses its way on the hard half of the frames.
TEST(AblationPieces, OnlyWhatAllFinishedIsCompared) {
    const auto piece = [](double error, std::size_t last_tracked) {
        AblationPiece one;
        one.pass = error > 1 ? kOdd : kForward;
        for (std::size_t v = 0; v < kAblationVariants; ++v) {
            VariantRun& run = one.runs[v];
            run.frames = 100;
            run.tracked = v + 1 < kAblationVariants ? 100 : last_tracked;
            Evaluation evaluation;
            evaluation.rpe_second.translation.rmse = evaluation.rpe_second.rotation.rmse = error;
            evaluation.rpe_frame = evaluation.rpe_second;
            evaluation.rpe_second.translation.count = evaluation.rpe_second.rotation.count = 60;
            evaluation.rpe_frame.translation.count = evaluation.rpe_frame.rotation.count = 90;
            run.errors.add(evaluation);
        }
        return one;
    };
    const std::size_t last = kAblationVariants - 1;
    AblationPiece hard = piece(5, 100);
    const auto pooledWith = [&](const AblationPiece& second) { return poolPieces({piece(1, 95), second}); };

    PooledPieces pooled = pooledWith(hard);
    EXPECT_EQ(pooled.compared, 2U);
    EXPECT_EQ(pooled.failures(), "");
    for (const VariantRun& run : pooled.variants)
        EXPECT_NEAR(run.errors.metresPerSecond().value(), std::sqrt(13.0), 1e-12);

    const auto expectFirstOnly = [&](const AblationPiece& second) {
        pooled = pooledWith(second);
        EXPECT_EQ(pooled.judged, 2U);
        EXPECT_EQ(pooled.compared, 1U);
        EXPECT_EQ(pooled.failed[last], 1U);
        EXPECT_EQ(pooled.failures(), std::string(label(kAllCoarsePoints[last])) + " 1");
        for (const VariantRun& run : pooled.variants) {
            EXPECT_EQ(run.errors.metresPerSecond(), 1.0);
            EXPECT_EQ(run.errors.degPerFrame(), 1.0);
            EXPECT_EQ(run.frames, 200U);
        }
    };
    hard.runs[last].tracked = 89;
    expectFirstOnly(hard);
    hard = piece(5, 100);
    hard.runs[last].errors = PooledErrors();  // gave no poses to compare
    expectFirstOnly(hard);
    EXPECT_EQ(poolPieces({hard}, kOdd).compared, 0U);
    EXPECT_EQ(poolPieces({hard}, kForward).judged, 0U);

    for (VariantRun& run : hard.runs) run.errors = PooledErrors();  // no ground truth there: nobody's fault
    pooled = pooledWith(hard);
    EXPECT_EQ(pooled.judged, 1U);
    EXPECT_EQ(pooled.failures(), "");
}

// DSO's threshold of 7 grey levels is absolute, Canny's here is not: faint images are too hard for DSO alone.
TEST_F(StudyAblation, AVariantThatFailsDoesNotChangeWhatIsCompared) {
    const testing::Sequence plain = room(18);
    testing::Sequence faint = plain;
    for (RgbdFrame& frame : faint.frames) {
        cv::Mat grey;
        frame.grey.convertTo(grey, CV_8U, 0.035, 115);
        frame.grey = grey;
    }
    StudyInput first = input("plain", plain, true, false), second = input("faint", faint, true, false);
    first.options.edges.min_high_threshold = second.options.edges.min_high_threshold = 4;
    const StudyReport report = studyAblation({first, second}, folder());
    const auto rows = table("ablation.csv");
    ASSERT_EQ(rows.size(), 1U + 2 * 5 * 4 + 4);
    for (std::size_t v = 0; v < 4; ++v) {
        const auto& of_plain = rows[1 + 4 * 4 + v];
        const auto& of_faint = rows[1 + 9 * 4 + v];
        const auto& of_both = rows[1 + 10 * 4 + v];
        ASSERT_EQ(of_plain[0] + of_plain[1] + of_both[0], "plainallall");
        EXPECT_NE(of_plain[5], "");
        for (std::size_t column : {3, 4, 5, 6}) {
            EXPECT_EQ(of_faint[column], "") << v;
            EXPECT_EQ(of_both[column], of_plain[column]) << v;
        }
        EXPECT_EQ(of_both[10], "8");
        EXPECT_EQ(of_both[11], "4");
        EXPECT_EQ(of_both[12], v == 0 ? "4" : "0") << of_faint[2];
    }
    EXPECT_TRUE(says(report, "faint: of 4 pieces, 0 were finished by all; not finished: DSO's selection 4"));
    EXPECT_TRUE(says(report, "4 pieces of 8 left out for all, since not finished by: DSO's selection 4."));
    EXPECT_NE(report.summary.find("on 4 of 8 pieces, not finished: DSO's selection 4"), std::string::npos)
        << report.summary;
}

TEST_F(StudyAblation, WithoutGroundTruthAblationSaysSoAndGivesNoError) {
    const testing::Sequence sequence = room(8);
    const StudyReport report = studyAblation({input("a", sequence, false, false)}, folder());
    EXPECT_EQ(report.summary, "no recording with errors over a second");
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("no ground truth was found"), std::string::npos);
    for (const auto& row : table("ablation.csv")) {
        if (row[0] != "a") continue;
        EXPECT_EQ(row[3], "");
        EXPECT_EQ(row[5], "");
    }
}

TEST_F(StudyAblation, ARecordingThatIsGoneIsALineAndTheOthersGoOn) {
    const testing::Sequence sequence = room(8);
    const StudyReport report =
        studyAblation({lostInput("gone", sequence), input("a", sequence, true)}, folder());
    ASSERT_EQ(report.left_out.size(), 1U);
    EXPECT_EQ(report.left_out[0].name, "gone");
    EXPECT_EQ(report.left_out[0].reason, "cannot read gone");
    EXPECT_EQ(table("ablation.csv").size(), 1U + 5 * 4);
    EXPECT_THROW(studyAblation({lostInput("gone", sequence)}, folder()), std::runtime_error);
}

}  // namespace
}  // namespace roevo
