#include <gtest/gtest.h>

#include <filesystem>

#include "odometry_fixture.h"
#include "render_fixture.h"
#include "support/trajectory_files.h"

namespace roevo {
namespace {

using test::eurocText;
using test::expectError;
using test::readFile;
using test::writeFile;

constexpr char kRenderProgram[] = "roevo-render";

class RenderProgram : public test::RenderProgram {};

TEST_F(RenderProgram, EveryViewFillsThePicture) {
    for (const std::string view : {"iso", "top", "front"}) {
        const auto result =
            render({"--view", view, "--no-legend", "--size", "402x300"});  // a width that is no multiple of 4
        ASSERT_EQ(result.exit_code, 0) << view << ' ' << result.all();
        const cv::Mat picture = cv::imread(folder_ / "room.png");
        ASSERT_EQ(picture.size(), cv::Size(402, 300)) << view;
        const cv::Rect box = brightBox(picture);
        EXPECT_TRUE(box.width > 300 || box.height > 225) << view << " shows the room only in " << box;
    }
}

TEST_F(RenderProgram, FollowLooksFromBehindTheLastCamera) {
    const auto result = render({"--view", "follow", "--size", "400x300"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const cv::Mat picture = cv::imread(folder_ / "room.png");
    ASSERT_FALSE(picture.empty());
    // The trajectory's end, drawn in a warm red, is straight ahead of us.
    const cv::Mat middle = picture(cv::Rect(170, 100, 60, 150));
    int red = 0;
    for (int y = 0; y < middle.rows; ++y)
        for (int x = 0; x < middle.cols; ++x) {
            const auto& p = middle.at<cv::Vec3b>(y, x);
            red += p[2] > 110 && p[2] > 2 * p[0] && p[2] > 2 * p[1];
        }
    EXPECT_GT(red, 5);
}

TEST_F(RenderProgram, FollowReadsWhatPagesRead) {
    writeFile(folder_ / "euroc.csv", eurocText(readTumTrajectory(folder_ / "trajectory.txt")));
    ASSERT_EQ(render({"--view", "follow"}).exit_code, 0);
    const std::string expected = readFile(folder_ / "room.png");
    const auto result = render({"--view", "follow", "--trajectory", "mine=" + (folder_ / "euroc.csv")});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_TRUE(readFile(folder_ / "room.png") == expected);
}

// Share of the picture's pixels that are clearly of that colour (BGR channels that are high, the others low).
double shareOf(const cv::Mat& picture, bool blue, bool green, bool red) {
    int count = 0;
    for (const auto& p : cv::Mat3b(picture)) {
        const int high = std::max({p[0], p[1], p[2]});
        const auto is = [&](int c, bool wanted) { return wanted ? p[c] > 0.75 * high : p[c] < 0.5 * high; };
        count += high > 90 && is(0, blue) && is(1, green) && is(2, red);
    }
    return static_cast<double>(count) / static_cast<double>(picture.total());
}

TEST_F(RenderProgram, ShowsTheLayerThatIsWanted) {
    // Each layer in a place of its own: yellow edges, white co-visibility, cyan surface, orange or magenta
    // pseudo-edges.
    SceneContent content;
    const auto line = [](float x, Rgb colour) {
        MapEdge edge;
        for (int i = 0; i <= 100; ++i) {
            edge.points.emplace_back(x, 0.01f * static_cast<float>(i), 2.f);
            edge.colours.push_back(colour);
        }
        return edge;
    };
    content.map = {line(0, {250, 250, 0}), line(1, {250, 250, 0})};
    content.map.back().verdict = EdgeVerdict::kVanishing;
    content.keyframe_edges = {line(2, {250, 250, 0})};
    for (int i = 0; i <= 500; ++i)
        content.semi_dense.push_back({{3.f, 0.002f * static_cast<float>(i), 2.f}, {0, 250, 250}});
    content.point_size = 4;
    saveScene(folder_ / "room.3Dscene", *buildScene(content));
    const auto shown = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--view", "front", "--no-legend", "--size", "400x300"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = render(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        const cv::Mat picture = cv::imread(folder_ / "room.png");
        std::string layers;
        constexpr double kThere = 0.002;
        if (shareOf(picture, false, true, true) > kThere) layers += "edges ";
        if (shareOf(picture, true, true, true) > kThere) layers += "covisibility ";
        if (shareOf(picture, true, true, false) > kThere) layers += "semi-dense ";
        if (shareOf(picture, true, false, true) > kThere) layers += "pseudo-edges ";
        return layers;
    };
    EXPECT_EQ(shown({}), "edges ");
    for (const std::string layer : {"edges", "covisibility", "semi-dense", "pseudo-edges"})
        EXPECT_EQ(shown({"--layer", layer}), layer + ' ');
    EXPECT_EQ(shown({"--layer", "all"}), "edges covisibility semi-dense pseudo-edges ");
}

TEST_F(RenderProgram, OnWhiteEvenWhiteEdgesAreSeen) {
    // The room's long edges are white
    const auto result = render({"--background", "white", "--view", "front", "--size", "400x300"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const cv::Mat picture = cv::imread(folder_ / "room.png");
    EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255));
    EXPECT_EQ(picture.at<cv::Vec3b>(2, 397), cv::Vec3b(255, 255, 255));
    int grey = 0;
    for (const auto& p : cv::Mat3b(picture.rowRange(0, 100)))  // above the grid on the ground
        grey += p[0] < 190 && std::abs(p[0] - p[1]) < 12 && std::abs(p[1] - p[2]) < 12;
    EXPECT_GT(grey, 100);
}

TEST_F(RenderProgram, FailuresAreOneLine) {
    namespace fs = std::filesystem;
    expectError(render({"--size", "1000"}), 2, kRenderProgram, {"--size", "1000"});
    expectError(render({"--size", "8x8"}), 2, kRenderProgram, {"16"});
    expectError(render({"--view", "inside"}), 2, kRenderProgram, {"--view"});
    expectError(render({"--view", "follow", "--trajectory", folder_ / "none.txt"}), 1, kRenderProgram,
                {"none.txt"});
    expectError(render({"--trajectory", folder_ / "none.txt"}), 2, kRenderProgram,
                {"--trajectory", "follow"});
    // This scene has edges only
    EXPECT_EQ(render({"--layer", "all"}).exit_code, 0);
    for (const std::string layer : {"covisibility", "semi-dense", "pseudo-edges"})
        expectError(render({"--layer", layer}), 1, kRenderProgram,
                    {"no layer '" + layer + "'", "it has edges"});
    expectError(render({"--layer", "walls"}), 2, kRenderProgram, {"--layer", "walls"});
    const std::string png = folder_ / "x.png";
    expectError(test::runProgram(kRenderProgram, {"--scene", folder_ / "none.3Dscene", "--output", png}), 1,
                kRenderProgram, {"none.3Dscene", "No such file"});
    expectError(test::runProgram(kRenderProgram, {"--scene", folder_ / "trajectory.txt", "--output", png}), 1,
                kRenderProgram, {"not a whole MRPT .3Dscene"});
    fs::copy_file(folder_ / "room.3Dscene", folder_ / "cut.3Dscene");
    fs::resize_file(folder_ / "cut.3Dscene", fs::file_size(folder_ / "cut.3Dscene") / 2);
    expectError(test::runProgram(kRenderProgram, {"--scene", folder_ / "cut.3Dscene", "--output", png}), 1,
                kRenderProgram, {"cut.3Dscene"});
    expectError(test::runProgram(kRenderProgram, {"--scene", folder_ / "room.3Dscene", "--output",
                                                  folder_ / "no/such/x.png"}),
                1, kRenderProgram, {"cannot write"});
    expectError(test::runProgram(kRenderProgram,
                                 {"--scene", folder_ / "room.3Dscene", "--output", folder_ / "x.txt"}),
                2, kRenderProgram, {".png"});
    EXPECT_FALSE(fs::exists(png));
}

TEST_F(RenderProgram, AForeignSceneIsShownAsItIsButHasNoLayers) {
    const auto scene = buildScene({});
    scene->removeObject(scene->getByName(SceneNames::kEdges));
    saveScene(folder_ / "room.3Dscene", *scene);
    for (const std::string layer : {"edges", "covisibility", "semi-dense", "pseudo-edges", "all"})
        expectError(render({"--layer", layer}), 1, kRenderProgram,
                    {"no layer '" + layer + "'", "it has none"});
}

// From the recording to the picture.
class RenderOdometry : public test::OdometryProgram {
  protected:
    static constexpr const char* kRender = "roevo-render";
    test::ProgramResult render(const std::string& layer) const {
        return test::runProgram(kRender, {"--scene", output() + "/map.3Dscene", "--output",
                                          folder_ / "map.png", "--size", "200x150", "--layer", layer});
    }
    std::string plyHead() const {
        const std::string ply = test::readFile(output() + "/map_semi_dense.ply");
        return ply.substr(0, ply.find("end_header"));
    }
};

TEST_F(RenderOdometry, TheSurfaceIsALayerUnlessItIsSwitchedOff) {
    ASSERT_EQ(runFrames(test::slidingRecording(15)).exit_code, 0);
    for (const std::string layer : {"edges", "covisibility", "semi-dense", "all"}) {
        const auto result = render(layer);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        EXPECT_NE(result.out.find("layer " + layer), std::string::npos) << result.out;
    }
    const auto points = summary()["map"]["semi_dense_points"].get<std::size_t>();
    EXPECT_GT(points, 100u);
    EXPECT_NE(plyHead().find("element vertex " + std::to_string(points) + "\n"), std::string::npos);

    ASSERT_EQ(run(folder_ / "recording", {"--set", "mapping.semi_dense_points=0"}).exit_code, 0);
    expectError(render("semi-dense"), 1, kRender, {"no layer 'semi-dense'", "edges, covisibility"});
    EXPECT_NE(plyHead().find("element vertex 0\n"), std::string::npos);

    // Without mapping nobody knows which edges are the same
    ASSERT_EQ(run(folder_ / "recording", {"--mode", "tr"}).exit_code, 0);
    EXPECT_EQ(render("semi-dense").exit_code, 0);
    expectError(render("covisibility"), 1, kRender, {"no layer 'covisibility'", "edges, semi-dense"});
    expectError(run(folder_ / "recording", {"--set", "mapping.semi_dense_points=-1"}), 2, "roevo-odometry",
                {"mapping.semi_dense_points", "0 to 50000"});
}

}  // namespace
}  // namespace roevo
