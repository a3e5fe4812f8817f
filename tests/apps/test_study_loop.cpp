// The error between start and end of paths that return.
#include "study_fixture.h"

namespace roevo {
namespace {

using test::sliding;

/// There and back again: the end is where the start is.
testing::Sequence thereAndBack(int frames) {
    testing::Sequence sequence = sliding(frames);
    const double mirror = 2 * sequence.frames.back().timestamp + 1 / kFrameRate;
    for (std::size_t i = sequence.frames.size(); i-- > 0;) {
        sequence.frames.push_back(sequence.frames[i]);
        sequence.truth.push_back(sequence.truth[i]);
        sequence.frames.back().timestamp = mirror - sequence.frames.back().timestamp;
        sequence.truth.back().timestamp = mirror - sequence.truth.back().timestamp;
    }
    return sequence;
}

using StudyLoop = test::StudyFolder;

TEST_F(StudyLoop, TellsTheErrorAtTheEnd) {
    testing::Sequence sequence = thereAndBack(12);
    StudyInput exact = input("exact", sequence, true), bent = exact;
    exact.modes = bent.modes = {Mode::kBundleAdjustment, Mode::kTracking};
    bent.name = "bent";
    bent.ground_truth.back().T_world_camera.translation().z() += 0.008;  // as if the end had drifted by 8 mm
    const StudyReport report = studyLoop({exact, bent}, folder());
    const auto rows = table("loop.csv");
    ASSERT_EQ(rows.size(), 1u + 2 * 3) << "ba with loops and without, tr";
    EXPECT_EQ(rows[0][5], "loop_error_m");
    for (std::size_t row = 1; row < rows.size(); ++row) {
        const bool is_bent = row > 3;
        EXPECT_EQ(rows[row][0], is_bent ? "bent" : "exact");
        EXPECT_EQ(rows[row][1], row % 3 == 0 ? "tr" : "ba");
        EXPECT_EQ(rows[row][2], row % 3 == 2 ? "yes" : "no");
        EXPECT_NEAR(std::stod(rows[row][4]), is_bent ? 0.008 : 0, 1e-9) << "start to end";
        EXPECT_NEAR(std::stod(rows[row][5]), is_bent ? 0.008 : 0, 0.003);
        EXPECT_NEAR(std::stod(rows[row][6]), 0, 0.2) << "degrees";
        EXPECT_EQ(rows[row][13], "");
    }
    EXPECT_NE(report.table.find("| exact | ba | closed | "), std::string::npos) << report.table;
    EXPECT_NE(report.summary.find("2 paths that return"), std::string::npos) << report.summary;
}

TEST_F(StudyLoop, APathThatDoesNotReturnIsRefusedByName) {
    const testing::Sequence away = sliding(12), back = thereAndBack(8);
    StudyInput returns = input("returns", back, true);
    returns.modes = {Mode::kTracking};
    const StudyReport report =
        studyLoop({input("away", away, true), returns, input("none", back, false)}, folder());
    ASSERT_EQ(report.left_out.size(), 2u);
    EXPECT_EQ(report.left_out[0].name, "away");
    EXPECT_NE(report.left_out[0].reason.find("does not return"), std::string::npos)
        << report.left_out[0].reason;
    EXPECT_EQ(report.left_out[1].reason, "no ground truth was found");
    EXPECT_EQ(table("loop.csv").size(), 2u);
    EXPECT_THROW(studyLoop({input("away", away, true)}, folder()), std::runtime_error);
}

}  // namespace
}  // namespace roevo
