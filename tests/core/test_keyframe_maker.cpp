// What local mapping tells about a keyframe reaches all of its points, and nothing else does.
#include <gtest/gtest.h>

#include "odometry/keyframe_maker.h"

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
        image.y.push_back(20);
        image.edge_of.push_back(i < 6 ? 0 : 1);
        keyframe.edges.weight.push_back(0.5F + at);
        keyframe.photometric.source.push_back(i);
        keyframe.photometric.weight.push_back(0.25F + at);
        for (auto* set : {&keyframe.edges.x, &keyframe.photometric.x}) set->push_back(at);
        for (auto* set : {&keyframe.edges.y, &keyframe.photometric.y}) set->push_back(2 * at);
        for (auto* set : {&keyframe.edges.z, &keyframe.photometric.z}) set->push_back(3 + at);
    }
    return keyframe;
}

TEST(KeyframeFromMap, EachPointTakesItsNearestOneOfTheSameEdge) {
    const Keyframe before = keyframeOfTwoEdges();
    Keyframe keyframe = before;
    MapUpdate update;
    update.source = {1, 4, 7};
    update.weight = {0.5F, 1, 0};
    update.depth_ratio = {1, 1.1F, 0.9F};
    takeFromMap(keyframe, update);
    for (std::size_t i = 0; i < before.edges.size(); ++i) {
        const std::size_t from = i < 3 ? 0 : i < 6 ? 1 : 2;
        const float ratio = update.depth_ratio[from], weight = update.weight[from];
        EXPECT_FLOAT_EQ(keyframe.edges.x[i], before.edges.x[i] * ratio) << i;
        EXPECT_FLOAT_EQ(keyframe.edges.y[i], before.edges.y[i] * ratio) << i;
        EXPECT_FLOAT_EQ(keyframe.edges.z[i], before.edges.z[i] * ratio) << i;
        EXPECT_FLOAT_EQ(keyframe.photometric.z[i], before.photometric.z[i] * ratio) << i;
        EXPECT_FLOAT_EQ(keyframe.edges.weight[i], before.edges.weight[i] * weight) << i;
        EXPECT_FLOAT_EQ(keyframe.photometric.weight[i], before.photometric.weight[i] * weight) << i;
    }
}

TEST(KeyframeFromMap, NoNewsChangesNothing) {
    const Keyframe before = keyframeOfTwoEdges();
    Keyframe keyframe = before;
    MapUpdate update;
    takeFromMap(keyframe, update);
    update.source = {1, 4, 7};
    takeFromMap(keyframe, update);
    EXPECT_EQ(keyframe.edges.z, before.edges.z);
    EXPECT_EQ(keyframe.edges.weight, before.edges.weight);
    EXPECT_EQ(keyframe.photometric.weight, before.photometric.weight);
}

}  // namespace
}  // namespace roevo
