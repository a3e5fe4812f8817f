// Gaps cut into recordings: what was seen before them, and whether the camera is found again.
#include "known_view.h"
#include "study_fixture.h"
#include "study_source.h"

namespace roevo {
namespace {

using test::sliding;

using StudyGaps = test::StudyFolder;

TEST_F(StudyGaps, WhatIsKnownOfAViewIsWhatItSharesWithThoseBefore) {
    testing::Sequence sequence = sliding(40);
    // The bare wall, 2 m away: the camera slides by 0.39 m, its view is 2.13 m wide
    for (RgbdFrame& frame : sequence.frames) frame.depth = cv::Mat(frame.depth.size(), CV_32F, cv::Scalar(2));
    const KnownViews views(input("wall", sequence, true));
    ASSERT_EQ(views.times().size(), 40u);
    EXPECT_EQ(views.times()[3], sequence.frames[3].timestamp);
    EXPECT_NEAR(views.knownShare(39, 1), 1 - 0.39 * 300 / (2 * 320), 1. / 32);
    EXPECT_EQ(views.knownShare(39, 39), 1) << "the frame before it sees the same but for half a cell";
    EXPECT_EQ(views.knownShare(39, 0), 0) << "nothing was before";
}

TEST_F(StudyGaps, AnotherDepthInTheSameDirectionIsNotKnown) {
    testing::Sequence sequence = sliding(2);
    sequence.frames[0].depth = cv::Mat(240, 320, CV_32F, cv::Scalar(2));
    sequence.frames[1].depth = cv::Mat(240, 320, CV_32F, cv::Scalar(2.5));
    const KnownViews views(input("wall", sequence, true));
    EXPECT_EQ(views.knownShare(1, 1), 0);
}

TEST_F(StudyGaps, FramesAreCutOutAndTheCameraIsFoundAgain) {
    const testing::Sequence sequence = sliding(45);
    StudyInput cut = input("slides", sequence, true);
    cut.gaps = {3, 200};
    const StudyReport report = studyGaps({cut}, folder());
    const auto rows = table("gaps.csv");
    ASSERT_EQ(rows.size(), 1u + 10) << "200 frames cannot be cut out of 45";
    EXPECT_EQ(rows[0][5], "found_after");
    std::size_t before = 0;
    for (std::size_t row = 1; row < rows.size(); ++row) {
        EXPECT_EQ(rows[row][2], "3");
        const std::size_t first = std::stoul(rows[row][3]);
        EXPECT_GE(first, row == 1 ? 10 : before + 1);
        before = first;
        EXPECT_GT(std::stod(rows[row][4]), 0.9) << "3 cm further on the view is much the same";
        EXPECT_EQ(rows[row][5], "1");
        EXPECT_EQ(rows[row][6], "");
        EXPECT_LT(std::stod(rows[row][7]), 0.003);
        EXPECT_NEAR(std::stod(rows[row][9]), std::stod(rows[row][7]) / std::stod(rows[row][8]), 1e-2);
    }
    EXPECT_EQ(before, 32u) << "the last gap leaves ten frames";
    EXPECT_EQ(report.notes.at(0), "slides: too short for gaps of 200 frames");
    EXPECT_NE(report.table.find("| slides | 3 | 10 | 10 | 10 of 10 | "), std::string::npos) << report.table;
}

TEST_F(StudyGaps, TheRightFramesAreCutOutOfWhatIsDecodedAhead) {
    const testing::Sequence sequence = sliding(20);
    const StudyInput memory = input("slides", sequence, true);
    const auto source = withoutFrames(prefetch(memory.open()), 4, 10);
    std::vector<double> expected, stamps;
    for (const std::size_t i : {0, 1, 2, 3, 14, 15, 16, 17, 18, 19})
        expected.push_back(sequence.frames[i].timestamp);
    for (SourceFrame frame; source->next(frame);) stamps.push_back(frame.timestamp);
    EXPECT_EQ(stamps, expected);
}

TEST_F(StudyGaps, WhatCannotBeCutIsLeftOutByName) {
    const testing::Sequence sequence = sliding(12);
    StudyInput brief = input("brief", sequence, true);
    brief.gaps = {20};
    EXPECT_THROW(studyGaps({brief}, folder()), std::runtime_error);
    const testing::Sequence longer = sliding(30);
    StudyInput good = input("good", longer, true);
    good.gaps = {3};
    const StudyReport report = studyGaps({brief, good}, folder());
    ASSERT_EQ(report.left_out.size(), 1u);
    EXPECT_EQ(report.left_out[0].reason, "too short for any of the gaps");
    EXPECT_EQ(report.notes.size(), 1u) << "said once: " << report.notes.front();
    StudyInput blind = input("blind", sequence, false);
    blind.gaps = {3};
    EXPECT_THROW(studyGaps({blind}, folder()), std::runtime_error);
}

}  // namespace
}  // namespace roevo
