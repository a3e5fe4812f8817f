#include <gtest/gtest.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

using test::countEntries;
using test::errorOf;

SceneContent someContent() {
    SceneContent content;
    for (int e = 0; e < 20; e++) {
        MapEdge edge;
        for (int i = 0; i < 10; i++) {
            edge.points.emplace_back(0.1f * static_cast<float>(e), 0.05f * static_cast<float>(i),
                                     2 + 0.1f * static_cast<float>(e));
            edge.colours.push_back({static_cast<std::uint8_t>(e), static_cast<std::uint8_t>(i), 200});
        }
        content.map.push_back(edge);
    }
    for (int i = 0; i < 5; i++) {
        StampedPose pose;
        pose.timestamp = i;
        pose.T_world_camera.translation() << 0.1 * i, 0, 0;
        content.trajectory.push_back(pose);
        content.reference.push_back(pose);
    }
    content.keyframes = {{0, 0.0, content.trajectory[0].T_world_camera},
                         {1, 4.0, content.trajectory[4].T_world_camera}};
    content.camera = {640, 480, 500, 500, 320, 240, {}};
    return content;
}

template <class Object>
std::shared_ptr<Object> find(compat::Scene& scene, const char* name) {
    return std::dynamic_pointer_cast<Object>(scene.getByName(name));
}

TEST(SceneBuilder, ComesBackFromAFileWithEverythingInIt) {
    const test::TemporaryFolder folder;
    const auto scene = buildScene(someContent());
    saveScene(folder / "map.3Dscene", *scene);
    EXPECT_EQ(countEntries(folder.path()), 1);

    compat::Scene loaded;
    ASSERT_TRUE(loaded.loadFromFile(folder / "map.3Dscene"));
    const auto edges = find<mrpt::opengl::CPointCloudColoured>(loaded, SceneNames::kEdges);
    ASSERT_TRUE(edges);
    ASSERT_EQ(edges->size(), 200u);
    // The scene's z points up: a point ahead of the first camera lies along +x.
    const auto& first = edges->getPoint3Df(0);
    EXPECT_NEAR(first.x, 2, 1e-6);
    EXPECT_NEAR(first.y, 0, 1e-6);
    for (const char* name : {SceneNames::kTrajectory, SceneNames::kReference, SceneNames::kKeyframes}) {
        const auto tubes = find<mrpt::opengl::CSetOfTriangles>(loaded, name);
        ASSERT_TRUE(tubes) << name;
        EXPECT_GE(tubes->getTrianglesCount(), 4 * 6 * 2u) << name;
    }
    const auto lines = find<mrpt::opengl::CSetOfLines>(loaded, SceneNames::kKeyframeLines);
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->size(), 2 * 10u);
    EXPECT_TRUE(loaded.getByName(SceneNames::kGround));
    const auto& camera = loaded.getViewport()->getCamera();
    EXPECT_GT(camera.getZoomDistance(), 1);
    EXPECT_GT(camera.getPointingAtX(), 1);
}

TEST(SceneBuilder, FrustaSitWhereTheKeyframesAre) {
    SceneContent content = someContent();
    content.T_scene_world = Pose::Identity();
    content.keyframes = {content.keyframes[1]};
    const auto lines = find<mrpt::opengl::CSetOfLines>(*buildScene(content), SceneNames::kKeyframeLines);
    ASSERT_TRUE(lines);
    const auto apex = lines->begin()->point1, corner = lines->begin()->point2;
    EXPECT_NEAR(apex.x, 0.4, 1e-6);
    EXPECT_GT(corner.z, 0);       // opens forward
    EXPECT_LT(corner.x, apex.x);  // upper left corner first
    EXPECT_LT(corner.y, apex.y);
}

TEST(SceneBuilder, EmptyContentIsAScene) {
    const test::TemporaryFolder folder;
    saveScene(folder / "empty.3Dscene", *buildScene({}));
    compat::Scene loaded;
    EXPECT_TRUE(loaded.loadFromFile(folder / "empty.3Dscene"));
}

TEST(SceneBuilder, PlyHoldsEveryPointExactly) {
    const test::TemporaryFolder folder;
    const EdgeMap map = someContent().map;
    savePly(folder / "map.ply", map);
    std::ifstream in(folder / "map.ply", std::ios::binary);
    std::string line;
    std::size_t count = 0;
    while (std::getline(in, line) && line != "end_header")
        if (line.rfind("element vertex ", 0) == 0) count = std::stoul(line.substr(15));
    ASSERT_EQ(count, 200u);
    for (const MapEdge& edge : map)
        for (std::size_t i = 0; i < edge.points.size(); i++) {
            char bytes[15];
            ASSERT_TRUE(in.read(bytes, sizeof bytes));
            float xyz[3];
            std::memcpy(xyz, bytes, sizeof xyz);  // tests run on little-endian machines
            for (int axis = 0; axis < 3; axis++) EXPECT_EQ(xyz[axis], edge.points[i][axis]);
            for (std::size_t c = 0; c < 3; c++)
                EXPECT_EQ(static_cast<std::uint8_t>(bytes[12 + c]), edge.colours[i][c]);
        }
    EXPECT_EQ(in.peek(), EOF);
}

TEST(SceneBuilder, UnwritableOutputIsNamed) {
    EXPECT_NE(errorOf([] { savePly("/nowhere/map.ply", {}); }).find("/nowhere/map.ply"), std::string::npos);
    EXPECT_NE(
        errorOf([] { saveScene("/nowhere/map.3Dscene", *buildScene({})); }).find("/nowhere/map.3Dscene"),
        std::string::npos);
}

}  // namespace
}  // namespace roevo
