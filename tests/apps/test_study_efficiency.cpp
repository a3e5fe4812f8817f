// The comparison of times, on a small simulated room.
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/study_fixture.h"
#include "registration_steps.h"

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

TEST_F(StudyEfficiency, RegistrationsAreComparedAlikeToo) {
    const testing::Sequence sequence = room(12);
    const StudyReport report = studyEfficiency({input("a", sequence, false)}, folder());
    const auto rows = table("efficiency_registration.csv");
    ASSERT_EQ(rows.size(), 1U + 4);
    const auto number = [&](std::size_t row, std::size_t column) { return std::stod(rows[row][column]); };
    for (std::size_t row = 1; row <= 4; ++row) {
        EXPECT_EQ(rows[row][2], row <= 2 ? "as configured" : "alike");
        EXPECT_EQ(rows[row][7], "11");
        EXPECT_GT(number(row, 4), 200) << "points";
        EXPECT_LE(number(row, 4), FineOptions().max_points);
        EXPECT_GE(number(row, 5), 3) << "the search radius narrows down in two, and none ends before";
        EXPECT_LE(number(row, 5), FineOptions().max_iterations);
        // Mean against medians
        const double ns = 1e6 * number(row, 3) / (number(row, 4) * number(row, 5));
        EXPECT_GT(number(row, 6), ns / 2);
        EXPECT_LT(number(row, 6), ns * 2);
    }
    EXPECT_EQ(rows[3][4], rows[4][4]) << "the same points";
    for (std::size_t row : {3, 4}) EXPECT_EQ(rows[row][5], "5") << "the same steps";
    EXPECT_LT(number(3, 3), number(1, 3)) << "fewer steps, fewer residuals";
    EXPECT_TRUE(says(report, "ROEVO as configured: at most 12 steps, at most 3500 points"));
    EXPECT_TRUE(exists("efficiency_registration.svg"));
}

TEST(RegistrationSteps, LookedUpPointsAreCounted) {
    for (const int most : {1, 7, 100, 1000})
        for (std::size_t all : {1, 2, 99, 100, 101, 250, 999}) {
            FineOptions options;
            options.max_points = most;
            Keyframe keyframe;
            for (std::size_t i = 0; i < all; ++i) keyframe.edges.image.addPoint(0, 0, 1, 0, 1);
            keyframe.edges.image.finishEdge();
            const std::size_t limit = static_cast<std::size_t>(most), stride = (all + limit - 1) / limit;
            std::size_t expected = 0;
            for (std::size_t i = stride / 2; i < all; i += stride) ++expected;
            EXPECT_EQ(lookedUpPoints(keyframe, options), expected) << most << ' ' << all;
        }
}

}  // namespace
}  // namespace roevo
