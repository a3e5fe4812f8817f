// What of a map shows nothing new, and what becomes of what was linked to it.
#include <gtest/gtest.h>

#include "core/support/mapping_world.h"
#include "odometry/stored_map.h"

namespace roevo {
namespace {

/// Keyframes with the same edges, one after the other: each sees those of the one before.
StoredMap chainOf(const std::vector<Pose>& poses) {
    const auto curves = testing::room();
    StoredMap map;
    for (std::size_t id = 0; id < poses.size(); ++id) {
        const MapKeyframe keyframe =
            testing::makeKeyframe(static_cast<int>(id), poses[id], curves, testing::seeAll(curves, 0.3))
                .keyframe;
        const int before = static_cast<int>(id) - 1;
        map.graph.keyframes.push_back({static_cast<int>(id), static_cast<double>(id), poses[id], 0});
        map.graph.links.push_back(
            {before, before < 0 ? poses[id] : Pose(poses[id - 1].inverse() * poses[id]), {}});
        map.graph.covariances.push_back(Matrix6d::Identity());
        KeptKeyframe edges{PackedKeyframe(keyframe), 2, {}, {}, {}, {}};
        const int count = edges.points.numEdges();
        if (before >= 0) {
            edges.links.push_back({before, {}});
            for (int e = 0; e < count; ++e)
                edges.links[0].links.push_back(
                    {static_cast<std::uint16_t>(e), static_cast<std::uint16_t>(e), 9});
        }
        edges.found.resize(static_cast<std::size_t>(count));
        map.edges.push_back(std::move(edges));
        map.places.emplace_back();
        map.surfaces.emplace_back();
    }
    return map;
}

TEST(LeaveOutCovered, WhatIsBesideThoseThatStayIsLinkedToThem) {
    std::vector<Pose> poses;
    for (const double x : {0., 0.02, 0.04, 0.2, 0.22}) poses.push_back(Pose(Eigen::Translation3d(x, 0, 0)));
    StoredMap map = chainOf(poses);
    leaveOutCovered(KeyframeOptions(), 0, map);
    ASSERT_EQ(map.graph.keyframes.size(), 2U);
    EXPECT_EQ(map.graph.keyframes[1].timestamp, 3);
    EXPECT_EQ(map.graph.links[1].keyframe, 0);
    EXPECT_NEAR(map.graph.links[1].T_keyframe_camera.translation().x(), 0.2, 1e-12);
    ASSERT_EQ(map.edges[1].links.size(), 1U);
    EXPECT_EQ(map.edges[1].links[0].other, 0);
    EXPECT_EQ(static_cast<int>(map.edges[1].links[0].links.size()), 2 * map.edges[1].points.numEdges());
    for (const auto& link : map.edges[1].links[0].links) EXPECT_EQ(link.edge, link.other_edge);
    EXPECT_EQ(faultOf(map).find("keyframe"), std::string::npos) << faultOf(map);
}

TEST(LeaveOutCovered, WhatWasThereAndWhatShowsSomethingNewStays) {
    const std::vector<Pose> poses(4);
    StoredMap map = chainOf(poses);
    leaveOutCovered(KeyframeOptions(), 2, map);
    EXPECT_EQ(map.graph.keyframes.size(), 2U) << "those before the second one stay";
    // The second two see the same of each other, and not what the first two see
    map = chainOf(poses);
    map.edges[2].links.clear();
    leaveOutCovered(KeyframeOptions(), 0, map);
    ASSERT_EQ(map.graph.keyframes.size(), 2U);
    EXPECT_EQ(map.graph.keyframes[1].timestamp, 2);
}

}  // namespace
}  // namespace roevo
