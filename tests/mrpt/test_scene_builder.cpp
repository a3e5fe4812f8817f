#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/scene_builder.h"
#include "roevo_mrpt/scene_objects.h"
#include "roevo_mrpt/simple_map.h"

namespace roevo {
namespace {

using test::countEntries;
using test::errorOf;

SceneContent someContent() {
    SceneContent content;
    for (int e = 0; e < 20; e++) {
        MapEdge edge;
        for (int i = 0; i < 10; i++) {
            // Too far apart to be joined
            edge.points.emplace_back(0.1f * static_cast<float>(e), 0.3f * static_cast<float>(i),
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
    const auto edges = find<compat::scene::CPointCloudColoured>(loaded, SceneNames::kEdges);
    ASSERT_TRUE(edges);
    ASSERT_EQ(edges->size(), 200u);
    // The scene's z points up: a point ahead of the first camera lies along +x.
    const auto& first = edges->getPoint3Df(0);
    EXPECT_NEAR(first.x, 2, 1e-6);
    EXPECT_NEAR(first.y, 0, 1e-6);
    for (const char* name : {SceneNames::kTrajectory, SceneNames::kReference, SceneNames::kKeyframes}) {
        const auto tubes = find<compat::scene::CSetOfTriangles>(loaded, name);
        ASSERT_TRUE(tubes) << name;
        EXPECT_GE(tubes->getTrianglesCount(), 4 * 6 * 2u) << name;
    }
    const auto lines = find<compat::scene::CSetOfLines>(loaded, SceneNames::kKeyframeLines);
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->size(), 2 * 10u);
    EXPECT_TRUE(loaded.getByName(SceneNames::kGround));
    const auto& camera = loaded.getViewport()->getCamera();
    EXPECT_GT(camera.getZoomDistance(), 1);
    EXPECT_GT(camera.getPointingAtX(), 1);
}

TEST(SceneBuilder, TheGroundTruthIsDashedAroundTheTrajectory) {
    SceneContent content = someContent();
    content.trajectory.clear();
    for (int i = 0; i < 200; ++i) {
        StampedPose pose;
        pose.timestamp = i;
        pose.T_world_camera.translation().x() =
            0.01 * i + (i < 100 ? 0 : 1);  // a step as long as both halves
        content.trajectory.push_back(pose);
    }
    content.reference = content.trajectory;
    const auto scene = buildScene(content);
    const auto drawn =
        [&](const char* name) {  // m of the tube, and its radius; y of the scene is -x of the world
            const auto tubes = find<compat::scene::CSetOfTriangles>(*scene, name);
            double length = 0, radius = 0;
            for (std::size_t i = 0; i < tubes->getTrianglesCount(); ++i) {
                compat::scene::TTriangle triangle;
                tubes->getTriangle(i, triangle);
                const auto& v = triangle.vertices;
                radius = std::max(radius, static_cast<double>(v[0].xyzrgba.pt.z));
                if (i % 12 == 0) length += std::abs(v[2].xyzrgba.pt.y - v[1].xyzrgba.pt.y);
            }
            return std::pair(length, radius);
        };
    const auto [length, radius] = drawn(SceneNames::kTrajectory);
    const auto [dashes, dash_radius] = drawn(SceneNames::kReference);
    EXPECT_NEAR(length, 2.99, 1e-3);
    EXPECT_NEAR(dashes, length / 2, 0.1);
    EXPECT_GT(dash_radius, 1.2 * radius);
}

TEST(SceneBuilder, FrustaSitWhereTheKeyframesAre) {
    SceneContent content = someContent();
    content.T_scene_world = Pose::Identity();
    content.keyframes = {content.keyframes[1]};
    const auto lines = find<compat::scene::CSetOfLines>(*buildScene(content), SceneNames::kKeyframeLines);
    ASSERT_TRUE(lines);
    const auto apex = lines->begin()->point1, corner = lines->begin()->point2;
    EXPECT_NEAR(apex.x, 0.4, 1e-6);
    EXPECT_GT(corner.z, 0);       // opens forward
    EXPECT_LT(corner.x, apex.x);  // upper left corner first
    EXPECT_LT(corner.y, apex.y);
}

using compat::scene::CPointCloudColoured;

Eigen::Vector3f positionOf(const CPointCloudColoured& cloud, std::size_t i) {
    const auto& p = cloud.getPoint3Df(i);
    return {p.x, p.y, p.z};
}

Rgb colourOf(const CPointCloudColoured& cloud, std::size_t i) {
    const auto c = cloud.getPointColor(i);
    return {c.R, c.G, c.B};
}

MapEdge edgeAt(float y, int keyframe, int cluster, EdgeVerdict verdict = EdgeVerdict::kTrue) {
    MapEdge edge;
    for (const float x : {0.f, 0.04f}) {
        edge.points.emplace_back(x, y, 1.f);
        edge.colours.push_back({10, 20, 30});
    }
    edge.keyframe_id = keyframe;
    edge.cluster = cluster;
    edge.verdict = verdict;
    return edge;
}

TEST(SceneBuilder, GapsOfAnEdgeAreFilledUnlessTheyAreUnusual) {
    SceneContent content;
    content.T_scene_world = Pose::Identity();
    const auto draw = [&](const std::vector<float>& along, std::uint8_t last_red) {
        MapEdge edge;
        for (std::size_t i = 0; i < along.size(); i++) {
            edge.points.emplace_back(along[i], 2 * along[i], 3.f);
            edge.colours.push_back({i + 1 < along.size() ? std::uint8_t{0} : last_red, 0, 100});
        }
        content.map = {edge};
        return find<CPointCloudColoured>(*buildScene(content), SceneNames::kEdges);
    };
    // 44.7 mm: eight points in between, on the line, their colours from one end's to the other's
    const auto line = draw({0, 0.02f}, 90);
    ASSERT_EQ(line->size(), 10u);
    for (std::size_t i = 0; i < 9; i++) {
        const Eigen::Vector3f p = positionOf(*line, i + 1);
        EXPECT_NEAR((p - positionOf(*line, i)).norm(), std::sqrt(5.) * 0.02 / 9, 1e-6);
        EXPECT_NEAR(p.y(), 2 * p.x(), 1e-6);
        EXPECT_EQ(colourOf(*line, i + 1), (Rgb{static_cast<std::uint8_t>(10 * (i + 1)), 0, 100}));
    }
    // Far away all gaps are wide, and are filled; one that is four times the others is not, nor a huge one.
    const double root5 = std::sqrt(5.);
    const auto wide = draw({0, 0.04f, 0.08f, 0.12f}, 0);
    EXPECT_EQ(wide->size(), 1 + 3 * static_cast<std::size_t>(std::ceil(root5 * 0.04 / 0.005)));
    EXPECT_EQ(draw({0, 0.04f, 0.08f, 0.24f}, 0)->size(), wide->size() - 17);
    EXPECT_EQ(draw({0, 0.2f, 0.4f}, 0)->size(), 3u);
}

TEST(SceneBuilder, PseudoEdgesAreALayerOfTheirOwn) {
    SceneContent content;
    content.T_scene_world = Pose::Identity();
    content.map = {edgeAt(0, 0, 0), edgeAt(1, 0, 1, EdgeVerdict::kSpread),
                   edgeAt(2, 0, 2, EdgeVerdict::kUnconfirmed), edgeAt(3, 0, 3, EdgeVerdict::kVanishing)};
    const test::TemporaryFolder folder;
    saveScene(folder / "map.3Dscene", *buildScene(content));
    compat::Scene scene;
    ASSERT_TRUE(scene.loadFromFile(folder / "map.3Dscene"));
    const auto edges = find<CPointCloudColoured>(scene, SceneNames::kEdges),
               pseudo = find<CPointCloudColoured>(scene, SceneNames::kPseudoEdges);
    ASSERT_TRUE(edges && pseudo);
    EXPECT_TRUE(edges->isVisible());
    EXPECT_FALSE(pseudo->isVisible());
    ASSERT_EQ(edges->size(), 2 * 9u);
    ASSERT_EQ(pseudo->size(), 2 * 9u);
    for (std::size_t i = 0; i < 9; i++) {
        EXPECT_EQ(positionOf(*edges, i).y(), 0);
        EXPECT_EQ(positionOf(*edges, 9 + i).y(), 2);
        EXPECT_EQ(positionOf(*pseudo, i).y(), 1);
        EXPECT_EQ(positionOf(*pseudo, 9 + i).y(), 3);
        EXPECT_EQ(colourOf(*edges, i), (Rgb{10, 20, 30}));
    }
    EXPECT_NE(colourOf(*pseudo, 0), colourOf(*pseudo, 9));  // says which kind
}

TEST(SceneBuilder, UncertainEdgesAreFainter) {
    SceneContent content;
    content.map = {edgeAt(0, 0, 0), edgeAt(1, 0, 1)};
    content.map[0].confidence = 0.2f;
    const auto edges = find<CPointCloudColoured>(*buildScene(content), SceneNames::kEdges);
    EXPECT_EQ(edges->getPointColor(9).A, 255);
    EXPECT_LT(edges->getPointColor(0).A, 180);
    EXPECT_GT(edges->getPointColor(0).A, 60);
}

TEST(SceneBuilder, CovisibilityHasOneColourPerSharedEdge) {
    SceneContent content;
    content.T_scene_world = Pose::Identity();
    constexpr int kClusters = 40;
    // Of two keyframes; besides, two edges of one keyframe in a cluster, which is not shared.
    for (int keyframe = 0; keyframe < 2; keyframe++)
        for (int c = 0; c < kClusters; c++)
            content.keyframe_edges.push_back(edgeAt(static_cast<float>(c), keyframe, c));
    for (int k = 0; k < 2; k++) content.keyframe_edges.push_back(edgeAt(-1, 1, kClusters));
    const auto scene = buildScene(content);
    const auto cloud = find<CPointCloudColoured>(*scene, SceneNames::kCovisibility);
    ASSERT_TRUE(cloud);
    EXPECT_FALSE(cloud->isVisible());
    ASSERT_EQ(cloud->size(), content.keyframe_edges.size() * 9);
    std::map<int, Rgb> colours;
    for (std::size_t i = 0; i < cloud->size(); i++) {
        const int cluster = static_cast<int>(std::lround(positionOf(*cloud, i).y()));
        const Rgb colour = colourOf(*cloud, i);
        EXPECT_EQ(colours.try_emplace(cluster, colour).first->second, colour) << cluster;
        const auto [low, high] = std::minmax_element(colour.begin(), colour.end());
        if (cluster < 0) {
            EXPECT_EQ(*low, *high);  // grey
            EXPECT_GT(*low, 180);
        } else {
            EXPECT_GT(*high - *low, 120) << cluster;
        }
    }
    // Neighbouring numbers look quite different, any two differ.
    for (int a = 0; a < kClusters; a++)
        for (int b = a + 1; b < kClusters; b++) {
            int difference = 0;
            for (std::size_t c = 0; c < 3; c++)
                difference = std::max(difference, std::abs(colours.at(a)[c] - colours.at(b)[c]));
            EXPECT_GT(difference, b == a + 1 ? 100 : 10) << a << ' ' << b;
        }
    EXPECT_FALSE(scene->getByName(SceneNames::kPseudoEdges));
    EXPECT_FALSE(scene->getByName(SceneNames::kSemiDense));
}

TEST(SceneBuilder, SemiDensePointsAreThereAndHidden) {
    SceneContent content;
    content.semi_dense = {{{1, 2, 3}, {4, 5, 6}}, {{-1, 0, 2}, {7, 8, 9}}};
    const auto cloud = find<CPointCloudColoured>(*buildScene(content), SceneNames::kSemiDense);
    ASSERT_TRUE(cloud);
    EXPECT_FALSE(cloud->isVisible());
    ASSERT_EQ(cloud->size(), 2u);
    EXPECT_TRUE(positionOf(*cloud, 0).isApprox(Eigen::Vector3f(3, -1, -2)));  // x forward, y left, z up
    EXPECT_EQ(colourOf(*cloud, 0), (Rgb{4, 5, 6}));
    EXPECT_EQ(colourOf(*cloud, 1), (Rgb{7, 8, 9}));
}

TEST(SceneBuilder, EmptyContentIsAScene) {
    const test::TemporaryFolder folder;
    saveScene(folder / "empty.3Dscene", *buildScene({}));
    compat::Scene loaded;
    EXPECT_TRUE(loaded.loadFromFile(folder / "empty.3Dscene"));
}

template <class Value>
Value take(std::istream& in) {
    Value value{};
    in.read(reinterpret_cast<char*>(&value), sizeof value);  // tests run on little-endian machines
    return value;
}

TEST(SceneBuilder, PlyHoldsEveryPointExactly) {
    const test::TemporaryFolder folder;
    EdgeMap map = someContent().map;
    for (std::size_t e = 0; e < map.size(); e++) {
        map[e].confidence = 0.05f * static_cast<float>(e);
        map[e].views = static_cast<int>(100 * e);
        map[e].verdict = static_cast<EdgeVerdict>(e % 4);
    }
    savePly(folder / "map.ply", map);
    std::ifstream in(folder / "map.ply", std::ios::binary);
    std::string line, properties, comments;
    std::size_t count = 0;
    while (std::getline(in, line) && line != "end_header") {
        if (line.rfind("element vertex ", 0) == 0) count = std::stoul(line.substr(15));
        if (line.rfind("property ", 0) == 0) properties += line.substr(9) + '\n';
        if (line.rfind("comment ", 0) == 0) comments += line;
    }
    ASSERT_EQ(count, 200u);
    EXPECT_EQ(properties,
              "float x\nfloat y\nfloat z\nuchar red\nuchar green\nuchar blue\n"
              "float confidence\nint views\nuchar verdict\nint edge\n");
    for (const char* word : {"confidence", "views", "verdict", "edge", "metres"})
        EXPECT_NE(comments.find(word), std::string::npos) << word;
    for (std::size_t e = 0; e < map.size(); e++) {
        const MapEdge& edge = map[e];
        for (std::size_t i = 0; i < edge.points.size(); i++) {
            for (int axis = 0; axis < 3; axis++) EXPECT_EQ(take<float>(in), edge.points[i][axis]);
            for (std::size_t c = 0; c < 3; c++) EXPECT_EQ(take<std::uint8_t>(in), edge.colours[i][c]);
            EXPECT_EQ(take<float>(in), edge.confidence);
            EXPECT_EQ(take<std::int32_t>(in), edge.views);
            EXPECT_EQ(take<std::uint8_t>(in), static_cast<std::uint8_t>(edge.verdict));
            EXPECT_EQ(take<std::int32_t>(in), static_cast<std::int32_t>(e));
        }
    }
    ASSERT_TRUE(in);
    EXPECT_EQ(in.peek(), EOF);
}

TEST(SceneBuilder, PlyOfPointsHoldsPositionAndColour) {
    const test::TemporaryFolder folder;
    const std::vector<ColouredPoint> points = {{{1, 2, 3}, {4, 5, 6}}, {{-1, 0.5f, 2}, {7, 8, 255}}};
    savePointsPly(folder / "points.ply", points);
    std::ifstream in(folder / "points.ply", std::ios::binary);
    std::string line, head;
    while (std::getline(in, line) && line != "end_header")
        if (line.rfind("comment", 0) != 0) head += line + '\n';
    EXPECT_EQ(head,
              "ply\nformat binary_little_endian 1.0\nelement vertex 2\n"
              "property float x\nproperty float y\nproperty float z\n"
              "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    for (const ColouredPoint& point : points) {
        for (int axis = 0; axis < 3; axis++) EXPECT_EQ(take<float>(in), point.position[axis]);
        for (const std::uint8_t channel : point.colour) EXPECT_EQ(take<std::uint8_t>(in), channel);
    }
    ASSERT_TRUE(in);
    EXPECT_EQ(in.peek(), EOF);
}

TEST(SceneBuilder, UnwritableOutputIsNamedWithTheReason) {
    const std::string why = ": No such file or directory";
    EXPECT_EQ(errorOf([] { savePointsPly("/nowhere/points.ply", {}); }),
              "cannot write /nowhere/points.ply" + why);
    EXPECT_EQ(errorOf([] { savePly("/nowhere/map.ply", {}); }), "cannot write /nowhere/map.ply" + why);
    EXPECT_EQ(errorOf([] { saveScene("/nowhere/map.3Dscene", *buildScene({})); }),
              "cannot write /nowhere/map.3Dscene" + why);
    EXPECT_EQ(errorOf([] { saveSimpleMap("/nowhere/map.simplemap", {}); }),
              "cannot write /nowhere/map.simplemap" + why);
}

}  // namespace
}  // namespace roevo
