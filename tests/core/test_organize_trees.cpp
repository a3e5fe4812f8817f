// The longest pair of routes on shapes whose answer is known.
#include <gtest/gtest.h>

#include <set>

#include "core/support/edge_masks.h"
#include "edges/organize.h"

namespace roevo {
namespace {

OrganizedEdges organized(const std::vector<std::string>& shape, int min_length) {
    EdgeMask mask = testing::drawnMask(shape);
    adjustAdjacency(mask);
    OrganizedEdges edges;
    EdgeOrganizer().organize(testing::evenGradient(mask.mask.size()), mask, 20, min_length, edges);
    return edges;
}

std::vector<int> lengths(const OrganizedEdges& edges) {
    std::vector<int> all;
    for (std::size_t e = 0; e + 1 < edges.begin.size(); ++e)
        all.push_back(edges.begin[e + 1] - edges.begin[e]);
    return all;
}

TEST(LongestRoutes, ALineIsOneEdgeFromEndToEnd) {
    const auto edges = organized({"####################"}, 5);
    ASSERT_EQ(lengths(edges), std::vector<int>{20});
    const bool rightward = edges.x.front() < edges.x.back();
    for (std::size_t i = 1; i < edges.size(); ++i) EXPECT_EQ(edges.x[i] - edges.x[i - 1], rightward ? 1 : -1);
}

TEST(LongestRoutes, SearchFromTheMiddleStillGivesTheWholeLine) {
    // The first pixel in raster order is the tip of a roof: both slopes together are the edge
    const auto edges = organized({"       #       ", "      # #      ", "     #   #     ", "    #     #    ",
                                  "   #       #   ", "  #         #  "},
                                 5);
    ASSERT_EQ(lengths(edges), std::vector<int>{11});
    EXPECT_EQ(std::abs(edges.x.front() - edges.x.back()), 10);
    EXPECT_EQ(edges.y.front(), edges.y.back());
}

TEST(LongestRoutes, YKeepsItsTwoLongestArms) {
    // Arms of 4 (upper left), 6 (upper right) and 9 (down)
    const auto edges = organized(
        {"            #   ", "           #    ", "  #       #     ", "   #     #      ", "    #   #       ",
         "     # #        ", "      #         ", "      #         ", "      #         ", "      #         ",
         "      #         ", "      #         ", "      #         ", "      #         ", "      #         "},
        5);
    ASSERT_EQ(edges.numEdges(), 1) << "the third arm of four pixels is too short to be an edge";
    EXPECT_EQ(lengths(edges)[0], 9 + 6);
    std::set<float> rows(edges.y.begin(), edges.y.end());
    EXPECT_EQ(rows.size(), 15U) << "it runs from the top right to the bottom";
    EXPECT_EQ(std::max(edges.x.front(), edges.x.back()), 12 + EdgeMask::kBorder);
}

TEST(LongestRoutes, ABranchThatIsLongEnoughIsAnEdgeOfItsOwn) {
    const auto edges = organized(
        {"            #   ", "           #    ", "  #       #     ", "   #     #      ", "    #   #       ",
         "     # #        ", "      #         ", "      #         ", "      #         ", "      #         ",
         "      #         ", "      #         ", "      #         ", "      #         ", "      #         "},
        4);
    ASSERT_EQ(edges.numEdges(), 2);
    EXPECT_EQ(lengths(edges)[1], 4);
}

TEST(LongestRoutes, CombKeepsItsSpineAndTwoTeeth) {
    // A spine of 21 with teeth of two: the longest route is the spine with the end teeth
    const auto edges =
        organized({"#    #    #    #    #", " #  # #  # #  # #  # ", "  ##   ##   ##   ##  "}, 5);
    ASSERT_GE(edges.numEdges(), 1);
    EXPECT_EQ(lengths(edges)[0], 21) << "a zigzag visits every column once";
}

TEST(LongestRoutes, SpurAtTheSeedIsCutOff) {
    // Raster order starts on the spur of two pixels above a long line
    const auto edges =
        organized({"      #               ", "       #              ", "####### ##############"}, 10);
    ASSERT_EQ(edges.numEdges(), 1);
    for (const float y : edges.y) EXPECT_GE(y, 1 + EdgeMask::kBorder);
    EXPECT_GE(lengths(edges)[0], 21);
}

TEST(LongestRoutes, ARingIsOpenedOnceAndKeptWhole) {
    const auto edges = organized({"   ####   ", "  #    #  ", " #      # ", "#        #", "#        #",
                                  "#        #", " #      # ", "  #    #  ", "   ####   "},
                                 5);
    ASSERT_EQ(edges.numEdges(), 1);
    EXPECT_EQ(lengths(edges)[0], 22);
}

TEST(LongestRoutes, SplitsWhereTheGradientTurns) {
    EdgeMask mask = testing::drawnMask({"########################"});
    for (const bool sharp : {true, false}) {
        Gradient gradient = testing::evenGradient(mask.mask.size(), 0, 400);
        const double turn = (sharp ? 30 : 10) * CV_PI / 180;  // limit: 20 degrees
        const cv::Rect right(EdgeMask::kBorder + 12, 0, gradient.gx.cols - EdgeMask::kBorder - 12,
                             gradient.gx.rows);
        gradient.gx(right).setTo(400 * std::sin(turn));
        gradient.gy(right).setTo(400 * std::cos(turn));
        OrganizedEdges edges;
        EdgeOrganizer().organize(gradient, mask, 20, 5, edges);
        EXPECT_EQ(edges.numEdges(), sharp ? 2 : 1);
        EXPECT_EQ(edges.size(), 24U);
    }
}

TEST(LongestRoutes, ShorterThanTheMinimumIsDroppedAndExactlyTheMinimumIsKept) {
    EXPECT_EQ(organized({"#########"}, 10).numEdges(), 0);
    EXPECT_EQ(organized({"##########"}, 10).numEdges(), 1);
    EXPECT_EQ(organized({"          "}, 3).numEdges(), 0);
    // Twelve pixels, but no route of ten: it is checked after organizing
    EXPECT_EQ(organized({"#   #   #", " #  #  # ", "  # # #  ", "   #     ", "   #     "}, 10).numEdges(), 0);
}

}  // namespace
}  // namespace roevo
