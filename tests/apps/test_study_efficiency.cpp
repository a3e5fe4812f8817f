// The comparison of times, on a small simulated room.
#include <gtest/gtest.h>

#include "apps/study_fixture.h"

namespace roevo {
namespace {

using test::room;
using StudyEfficiency = test::StudyFolder;

TEST_F(StudyEfficiency, TimesBothOnTheSameFrames) {
    const testing::Sequence sequence = room(16);
    const StudyReport report = studyEfficiency({input("a", sequence, false, true)}, folder());
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
    EXPECT_TRUE(exists("efficiency.svg"));
    EXPECT_EQ(report.plot_fault, "");
}

}  // namespace
}  // namespace roevo
