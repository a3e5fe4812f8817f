// Adjacency adjustment: both patterns really go, and what was one edge stays one.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "core/support/edge_masks.h"
#include "edges/organize.h"

namespace roevo {
namespace {

using testing::drawnMask;

/// Largest number of edge pixels in any 2x2 block.
int fullestBlock(const cv::Mat& mask) {
    int fullest = 0;
    for (int y = 0; y + 1 < mask.rows; ++y) {
        for (int x = 0; x + 1 < mask.cols; ++x) {
            fullest =
                std::max(fullest, mask.at<std::uint8_t>(y, x) + mask.at<std::uint8_t>(y, x + 1) +
                                      mask.at<std::uint8_t>(y + 1, x) + mask.at<std::uint8_t>(y + 1, x + 1));
        }
    }
    return fullest;
}

int components(const cv::Mat& mask) {
    cv::Mat labels;
    return cv::connectedComponents(mask, labels, 8) - 1;
}

void expectConsistent(const EdgeMask& edges) {
    const EdgeMask again = testing::maskFrom(edges.mask);
    EXPECT_EQ(edges.pixels, again.pixels) << "mask and pixel list differ";
}

TEST(Adjacency, NoBlockOfFourHoldsMoreThanTwo) {
    std::mt19937 random(21);
    for (const double share : {0.05, 0.2, 0.4, 0.6, 0.8, 1.0}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            EdgeMask edges = testing::randomMask(random, 48, 40, share);
            const cv::Mat before = edges.mask.clone();
            adjustAdjacency(edges);
            EXPECT_LE(fullestBlock(edges.mask), 2) << share;
            cv::Mat added = edges.mask & ~before & 1;
            EXPECT_EQ(cv::countNonZero(added), 0) << "it may only remove";
            expectConsistent(edges);
        }
    }
}

TEST(Adjacency, NeighboursOfAPixelAreNeverNeighboursOfEachOther) {
    std::mt19937 random(22);
    EdgeMask edges = testing::randomMask(random, 60, 60, 0.4);
    adjustAdjacency(edges);
    const auto at = [&](int x, int y) { return edges.mask.at<std::uint8_t>(y, x) != 0; };
    for (const auto p : edges.pixels) {
        const int x = p % 60, y = p / 60;
        std::vector<cv::Point> around;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                if ((dx != 0 || dy != 0) && at(x + dx, y + dy)) around.emplace_back(dx, dy);
            }
        }
        for (std::size_t i = 0; i < around.size(); ++i) {
            for (std::size_t j = i + 1; j < around.size(); ++j) {
                const cv::Point d = around[i] - around[j];
                EXPECT_GT(std::max(std::abs(d.x), std::abs(d.y)), 1);
            }
        }
    }
}

TEST(Adjacency, SimpleShapesStayConnected) {
    const std::vector<std::vector<std::string>> shapes = {
        {"#########",  // T
         "    #    ", "    #    ", "    #    "},
        {"#      ",  // L
         "#      ", "#      ", "#      ", "#######"},
        {"   #   ",  // plus
         "   #   ", "   #   ", "#######", "   #   ", "   #   ", "   #   "},
        {"###      ",  // stairs
         "  ###    ", "    ###  ", "      ###"},
        {"########",  // ring
         "#      #", "#      #", "#      #", "########"},
        {"##########", "          ", "          ", "          "}};
    for (const auto& shape : shapes) {
        EdgeMask edges = drawnMask(shape);
        const int before = components(edges.mask);
        adjustAdjacency(edges);
        EXPECT_EQ(components(edges.mask), before) << shape[0];
        EXPECT_LE(fullestBlock(edges.mask), 2) << shape[0];
        expectConsistent(edges);
    }
}

TEST(Adjacency, RemovesTheCentreOfATAndTheCornerOfAnL) {
    EdgeMask t = drawnMask({"#####", "  #  ", "  #  "});
    const auto before = t.pixels.size();
    adjustAdjacency(t);
    EXPECT_EQ(t.pixels.size(), before - 1);
    EXPECT_EQ(t.mask.at<std::uint8_t>(4, 6), 0);
    EdgeMask l = drawnMask({"#   ", "#   ", "####"});
    adjustAdjacency(l);
    EXPECT_EQ(l.mask.at<std::uint8_t>(6, 4), 0);
    EXPECT_EQ(l.pixels.size(), 5U);
}

TEST(Adjacency, LeavesLinesAlone) {
    for (const auto& shape : std::vector<std::vector<std::string>>{{"########"},
                                                                   {"#", "#", "#", "#"},
                                                                   {"#    ", " #   ", "  #  ", "   # "},
                                                                   {"##    ", "  ##  ", "    ##"}}) {
        EdgeMask edges = drawnMask(shape);
        const auto before = edges.pixels;
        adjustAdjacency(edges);
        EXPECT_EQ(edges.pixels, before);
    }
}

TEST(Adjacency, IsDoneAfterOneCall) {
    std::mt19937 random(23);
    for (int repeat = 0; repeat < 20; ++repeat) {
        EdgeMask edges = testing::randomMask(random, 50, 50, 0.5);
        adjustAdjacency(edges);
        const auto once = edges.pixels;
        adjustAdjacency(edges);
        EXPECT_EQ(edges.pixels, once);
    }
}

}  // namespace
}  // namespace roevo
