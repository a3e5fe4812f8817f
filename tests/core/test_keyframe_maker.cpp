// What changes a keyframe after it was made: the verdicts of the map, and another motion of its rows.
#include <gtest/gtest.h>

#include "tracking/keyframe.h"

namespace roevo {
namespace {

/// Two edges of six and three points at distinct places, each of which is photometric, too.
Keyframe keyframeOfTwoEdges() {
    Keyframe keyframe;
    OrganizedEdges& image = keyframe.edges.image;
    image.begin = {0, 6, 9};
    for (int i = 0; i < 9; ++i) {
        const auto at = static_cast<float>(i);
        image.x.push_back(10 + at);
        image.y.push_back(20 + at);
        image.edge_of.push_back(i < 6 ? 0 : 1);
        keyframe.edges.weight.push_back(0.5F + at);
        keyframe.photometric.source.push_back(i);
        keyframe.photometric.weight.push_back(0.25F + at);
        for (auto* points : {&keyframe.edges.points, &keyframe.photometric.points})
            points->add(at, 2 * at, 3 + at);
    }
    return keyframe;
}

TEST(KeyframeChanges, OnlyPseudoEdgesCountForLess) {
    const Keyframe before = keyframeOfTwoEdges();
    Keyframe keyframe = before;
    keyframe.weaken({EdgeVerdict::kTrue, EdgeVerdict::kVanishing}, 0.3);
    for (std::size_t i = 0; i < before.edges.size(); ++i) {
        const float factor = i < 6 ? 1 : 0.3F;
        EXPECT_FLOAT_EQ(keyframe.edges.weight[i], before.edges.weight[i] * factor) << i;
        EXPECT_FLOAT_EQ(keyframe.photometric.weight[i], before.photometric.weight[i] * factor) << i;
        EXPECT_EQ(keyframe.edges.points.z[i], before.edges.points.z[i]) << i;
    }
}

TEST(KeyframeChanges, PhotometricPointsThatAreNoEdgePointsCountAsBefore) {
    Keyframe keyframe = keyframeOfTwoEdges();
    const std::vector<float> before = keyframe.photometric.weight;
    keyframe.photometric.source.clear();  // as an experiment chooses them
    keyframe.weaken({EdgeVerdict::kSpread, EdgeVerdict::kVanishing}, 0.3);
    EXPECT_EQ(keyframe.photometric.weight, before);
}

TEST(KeyframeChanges, PhotometricPointsMoveWithTheEdgesThatTheyCameFrom) {
    const Keyframe before = keyframeOfTwoEdges();
    Keyframe keyframe = before;
    RowMotion rows;
    rows.velocity << 0.3, 0, 0.1;
    rows.seconds_per_row = 1e-3;
    keyframe.setRowMotion(rows);
    EXPECT_EQ(keyframe.row_motion, rows);
    for (std::size_t i = 0; i < before.edges.size(); ++i) {
        const Eigen::Vector3d p =
            rows.toReference(before.edges.points.at(i), static_cast<double>(before.edges.image.y[i]));
        EXPECT_NEAR(keyframe.edges.points.x[i], p.x(), 1e-5);
        EXPECT_EQ(keyframe.photometric.points.x[i], keyframe.edges.points.x[i]);
        EXPECT_EQ(keyframe.photometric.points.z[i], keyframe.edges.points.z[i]);
    }
    keyframe.setRowMotion(before.row_motion);
    EXPECT_NEAR(keyframe.edges.points.x[5], before.edges.points.x[5], 1e-4);
}

TEST(KeyframeChanges, SharesOfWhatWasFoundNeedEnoughTrials) {
    Keyframe keyframe = keyframeOfTwoEdges();
    EXPECT_EQ(keyframe.foundShares(), (std::vector<float>{-1, -1}));
    keyframe.count({6, 3}, {3, 0});
    EXPECT_EQ(keyframe.foundShares(), (std::vector<float>{-1, -1})) << "less than ten";
    keyframe.count({6, 3}, {6, 0});
    EXPECT_EQ(keyframe.foundShares(), (std::vector<float>{0.75F, -1}));
    keyframe.count({6, 6}, {});  // lost: nothing was looked for
    EXPECT_EQ(keyframe.foundShares(), (std::vector<float>{0.75F, -1}));
    // Days at rest
    for (int i = 0; i < 5; ++i) keyframe.count({1'000'000'000, 2}, {500'000'000, 1});
    EXPECT_NEAR(keyframe.foundShares()[0], 0.5F, 1e-6F);
}

}  // namespace
}  // namespace roevo
