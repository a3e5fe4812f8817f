#include <sys/stat.h>

#include <regex>

#include "render_page_fixture.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::expectError;
using test::RenderPage;

constexpr char kName[] = "roevo-render";

Eigen::Vector3d inScene(const Eigen::Vector3d& optical) {
    return {optical.z(), -optical.x(), -optical.y()};  // x forward, y left, z up
}

TEST_F(RenderPage, HoldsEveryPointToHalfAStep) {
    map_[2].verdict = EdgeVerdict::kVanishing;
    map_[3].confidence = 0;
    map_[0].points[50].x() += 1;  // depth jumps: not joined to its neighbours
    savePly(result() + "/map.ply", map_);
    const auto run = render();
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const json data = this->data();

    const auto edges = test::pointsOf(test::layerOf(data, "edges"));
    std::size_t i = 0;
    for (std::size_t e = 0; e < map_.size(); ++e)
        for (std::size_t k = 0; k < map_[e].points.size() && e != 2; ++k, ++i) {
            ASSERT_LT(i, edges.size());
            const Eigen::Vector3d truth = inScene(map_[e].points[k].cast<double>());
            EXPECT_LE((edges[i].position - truth).cwiseAbs().maxCoeff(), 0.5 * edges[i].step * 1.01 + 1e-6);
            EXPECT_EQ(edges[i].colour[0], test::kMagenta[0]);
            EXPECT_EQ(edges[i].colour[1], test::kMagenta[1]);
            const bool joined = k > 0 && !(e == 0 && (k == 50 || k == 51));
            EXPECT_EQ(edges[i].colour[3] > 0, joined) << e << ' ' << k;
            EXPECT_EQ(edges[i].colour[3] == 255, joined && e != 3) << "edges with little trust are faint";
        }
    EXPECT_EQ(i, edges.size());
    EXPECT_LT(edges.front().step, 0.0001) << "what is far off costs the first block nothing";
    EXPECT_EQ(test::layerOf(data, "pseudo-edges")["count"], 200);

    const auto surface = test::pointsOf(test::layerOf(data, "surface"));
    ASSERT_EQ(surface.size(), surface_.size());
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const Eigen::Vector3d truth = inScene(surface_[k].position.cast<double>());
        ASSERT_LE((surface[k].position - truth).cwiseAbs().maxCoeff(), 0.5 * surface[k].step * 1.01 + 1e-6);
        ASSERT_EQ(surface[k].colour[0], static_cast<int>(k % 256));
    }
}

TEST_F(RenderPage, NeedsNothingFromOutside) {
    ASSERT_EQ(render().exit_code, 0);
    const std::string html = test::readFile(page());
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos) << "the browser itself forbids it";
    for (const char* pattern : {R"(<(link|img|iframe|object|embed)\s+[a-z]+=)", R"(<script[^>]*\bsrc)",
                                R"((src|href)\s*=\s*["'])", R"(@import|url\(\s*["']?[a-z])"}) {
        std::smatch found;
        // In pieces: the library's recursion would not end in a megabyte of one line
        for (std::size_t at = 0; at < html.size(); at += 20000) {
            const std::string piece = html.substr(at, 20100);
            EXPECT_FALSE(std::regex_search(piece, found, std::regex(pattern))) << found.str();
        }
    }
    EXPECT_NE(html.find("Copyright (c) 2010-2019 three.js authors"), std::string::npos);
    EXPECT_NE(html.find("The above copyright notice and this permission notice shall be included"),
              std::string::npos);
    EXPECT_LT(html.size(), 1.2e6) << "three.js is 0.88 MB of it";
}

TEST_F(RenderPage, WhatItsScriptHidesIsNotShownByItsStyle) {
    ASSERT_EQ(render().exit_code, 0);
    const std::string html = test::readFile(page());
    for (const std::string id : {"colouring", "scale"}) {  // those with a display of their own
        EXPECT_NE(html.find("byId('" + id + "').hidden"), std::string::npos) << id;
        EXPECT_NE(html.find("#" + id + "[hidden]"), std::string::npos) << id;
    }
}

TEST_F(RenderPage, AlignsAllWithTheGroundTruth) {
    // A circle within a larger one: no motion brings them nearer, and every pose errs by the difference
    writeTumTrajectory(folder_ / "truth.txt", test::moved(test::kElsewhere, test::circle(1.1)));
    writeTumTrajectory(folder_ / "other.txt", test::moved(test::kElsewhere.inverse(), test::circle(1.25)));
    const auto run = render({"--ground-truth", folder_ / "truth.txt", "--trajectory",
                             "some = one=" + (folder_ / "other.txt"), folder_ / "other.txt"});
    // "some = one" has an equals sign too many: the name ends at the first
    expectError(run, 1, kName, {" one=", "other.txt"});
    const auto good = render({"--ground-truth", folder_ / "truth.txt", "--trajectory",
                              "some one=" + (folder_ / "other.txt"), folder_ / "other.txt"});
    ASSERT_EQ(good.exit_code, 0) << good.all();
    const json paths = data()["paths"];
    ASSERT_EQ(paths.size(), 5u);
    const double radius[] = {1, 1.02, 1.25, 1.25, 1.1};
    const char* role[] = {"final", "live", "other", "other", "truth"};
    for (std::size_t p = 0; p < 5; ++p) {
        EXPECT_EQ(paths[p]["role"], role[p]);
        const auto positions = test::positionsOf(paths[p]);
        const auto truth = test::circle(radius[p]);
        ASSERT_EQ(positions.size(), truth.size());
        for (std::size_t i = 0; i < positions.size(); ++i)
            EXPECT_LT((positions[i] - inScene(truth[i].T_world_camera.translation())).norm(), 1e-5)
                << p << ' ' << i;
        EXPECT_NEAR(test::numbersOf<float>(paths[p]["times"])[7], 0.7, 1e-4);
        if (p == 4) break;
        EXPECT_NEAR(paths[p]["ate"].get<double>(), std::abs(radius[p] - 1.1), 1e-6);
        for (const float error : test::numbersOf<float>(paths[p]["errors"]))
            EXPECT_NEAR(error, std::abs(radius[p] - 1.1), 1e-5);
    }
    EXPECT_EQ(paths[2]["name"], "some one");
    EXPECT_EQ(paths[3]["name"], "other");
    EXPECT_TRUE(paths[4]["errors"].is_null());
}

TEST_F(RenderPage, TakesTrajectoriesOfOtherFormatsAndNames) {
    // Rows without times are of the result's poses; nanoseconds are the same times
    std::string kitti, euroc;
    for (const StampedPose& pose : test::moved(test::kElsewhere, test::circle(1.25))) {
        const auto matrix = pose.T_world_camera.isometry().matrix();
        char text[200];
        for (int k = 0; k < 12; ++k) {
            std::snprintf(text, sizeof text, "%.12f%s", matrix(k / 4, k % 4), k < 11 ? " " : "\n");
            kitti += text;
        }
        const Eigen::Vector3d p = pose.T_world_camera.translation();
        const Eigen::Quaterniond q = pose.T_world_camera.rotation();
        std::snprintf(text, sizeof text, "%lld,%.12f,%.12f,%.12f,%.12f,%.12f,%.12f,%.12f\n",
                      std::llround(pose.timestamp * 1e9), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
        euroc += text;
    }
    test::writeFile(folder_ / "other.kitti", kitti);
    test::writeFile(folder_ / "other.csv", euroc);
    writeTumTrajectory(folder_ / "truth.txt", test::circle(1.1));
    const auto run = render({"--title", "a room", "--name", "mine", "--ground-truth", folder_ / "truth.txt",
                             "--trajectory", folder_ / "other.kitti", "e=" + (folder_ / "other.csv")});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    EXPECT_EQ(data()["title"], "a room");
    const json paths = data()["paths"];
    const char* name[] = {"mine", "live", "other", "e", "ground truth"};
    ASSERT_EQ(paths.size(), 5u);
    for (std::size_t p = 0; p < 5; ++p) EXPECT_EQ(paths[p]["name"], name[p]);
    for (const std::size_t p : {2, 3}) EXPECT_NEAR(paths[p]["ate"].get<double>(), 0.15, 1e-6) << p;

    test::writeFile(folder_ / "other.kitti", kitti.substr(0, kitti.find('\n') + 1));
    expectError(render({"--trajectory", folder_ / "other.kitti"}), 1, kName,
                {"other.kitti", "trajectory.txt"});
}

TEST_F(RenderPage, TakesTheGroundTruthOfTheRunOrGoesWithout) {
    writeTumTrajectory(result() + "/trajectory_truth.txt", test::circle(1.1));
    ASSERT_EQ(render().exit_code, 0);
    EXPECT_EQ(data()["paths"].size(), 3u);
    EXPECT_NEAR(data()["paths"][0]["ate"].get<double>(), 0.1, 1e-6);

    fs::remove(result() + "/trajectory_truth.txt");
    writeTumTrajectory(folder_ / "other.txt", test::moved(test::kElsewhere, test::circle(1.25)));
    const auto run = render({"--trajectory", "other=" + (folder_ / "other.txt")});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const json paths = data()["paths"];
    ASSERT_EQ(paths.size(), 3u);
    EXPECT_TRUE(paths[0]["ate"].is_null());
    const Eigen::Vector3d first = test::positionsOf(paths[2])[0];
    EXPECT_LT((first - Eigen::Vector3d(1.25, 0, 0)).norm(), 1e-5) << "aligned with the final trajectory";
}

TEST_F(RenderPage, NamesAreTextWhateverIsInThem) {
    ASSERT_EQ(render().exit_code, 0);
    const auto endsOfScripts = [&] {
        const std::string html = test::readFile(page());
        std::size_t count = 0;
        for (std::size_t at = 0; (at = html.find("</script", at)) != std::string::npos; ++at) ++count;
        return count;
    };
    const std::size_t before = endsOfScripts();
    writeTumTrajectory(folder_ / "other.txt", test::circle(1));
    const std::string name = "</script><b>&\"'\\ <!--<script>";
    const auto run = render({"--trajectory", name + "=" + (folder_ / "other.txt")});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    EXPECT_EQ(endsOfScripts(), before);
    EXPECT_EQ(data()["paths"][2]["name"], name);
    const std::string html = test::readFile(page());
    EXPECT_EQ(html.find("<b>"), std::string::npos);
    EXPECT_NE(html.find("<title>some room – "), std::string::npos);
}

TEST_F(RenderPage, LeavesOutPointsOfTheSurfaceFirstWhereItWouldBeTooLarge) {
    for (int i = 0; i < 90000; ++i) surface_.push_back({{0.001f * static_cast<float>(i), 0, 3}, {9, 9, 9}});
    savePointsPly(result() + "/map_semi_dense.ply", surface_);
    const auto run = render({"--max-size", "1.4"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    EXPECT_LE(fs::file_size(page()), 1400000u);
    EXPECT_GT(fs::file_size(page()), 1150000u) << "no more is left out than must be";
    EXPECT_NE(run.err.find("of 93000 points of the surface are left out"), std::string::npos) << run.err;
    EXPECT_EQ(test::layerOf(data(), "edges")["count"], 1410);
    EXPECT_EQ(data()["notes"].size(), 1u);
}

TEST_F(RenderPage, LinesKeepTheirEndsWhereEdgesMustBeThinned) {
    map_.clear();
    for (int e = 0; e < 300; ++e) {
        const float y = 0.01f * static_cast<float>(e);
        map_.push_back(test::lineOf({0, y, 1}, {2, y, 1}, 200));
    }
    savePly(result() + "/map.ply", map_);
    ASSERT_EQ(render({"--max-size", "1.2"}).exit_code, 0);
    EXPECT_LE(fs::file_size(page()), 1200000u);
    const auto points = test::pointsOf(test::layerOf(data(), "edges"));
    ASSERT_GT(points.size(), 600u);
    std::size_t begins = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_first = points[i].colour[3] == 0;
        begins += is_first;
        if (is_first) {
            EXPECT_NEAR(points[i].position.y(), 0, 1e-3);
        }
        if (i + 1 == points.size() || points[i + 1].colour[3] == 0) {
            EXPECT_NEAR(points[i].position.y(), -2, 1e-3);
        }
    }
    EXPECT_EQ(begins, 300u);
}

TEST_F(RenderPage, ShowsWhatIsThereAndSaysWhatIsNot) {
    for (const char* name :
         {"map.ply", "map_semi_dense.ply", "keyframes.txt", "trajectory_live.txt", "summary.json"})
        fs::remove(result() + "/" + name);
    const auto run = render();
    ASSERT_EQ(run.exit_code, 0) << run.all();
    EXPECT_NE(run.err.find("no map.ply"), std::string::npos) << run.err;
    EXPECT_EQ(data()["paths"].size(), 1u);
    EXPECT_EQ(data()["title"], "result");
}

TEST_F(RenderPage, ThePathIsAsLongAsTheRunSays) {  // which knows what was not measured
    writeSummary({{"path_length_m", 1.25}});
    ASSERT_EQ(render().exit_code, 0);
    EXPECT_EQ(data()["facts"][2], "path 1.25 m");
    writeSummary();
    ASSERT_EQ(render().exit_code, 0);
    EXPECT_EQ(data()["facts"][2], "path 6.18 m");
}

TEST_F(RenderPage, FailuresAreOneLineAndLeaveNoPage) {
    const auto with = [&](const std::string& input, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"--input", input, "--output", page()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kName, arguments);
    };
    expectError(with(folder_ / "none"), 1, kName, {"none", "no such folder"});
    expectError(with(result() + "/map.ply"), 1, kName, {"map.ply", "it is no folder"});
    expectError(with(folder_.path().string()), 1, kName, {"no trajectory.txt"});
    expectError(with(result(), {"--ground-truth", folder_ / "none.txt"}), 1, kName,
                {"none.txt", "No such file"});
    test::writeFile(folder_ / "late.txt", "900 0 0 0 0 0 0 1\n901 0 0 0 0 0 0 1\n902 0 0 1 0 0 0 1\n");
    expectError(with(result(), {"--ground-truth", folder_ / "late.txt"}), 1, kName,
                {"final: no pose", "900.000000"});
    expectError(with(result(), {"--trajectory", "a=" + (folder_ / "late.txt")}), 1, kName, {"a: no pose"});
    expectError(with(result(), {"--trajectory", "=" + (folder_ / "late.txt")}), 2, kName,
                {"is not NAME=FILE"});
    expectError(with(result(), {"--max-size", "0"}), 2, kName, {"--max-size"});
    expectError(with(result(), {"--layer", "edges"}), 2, kName, {"--layer", ".png"});
    expectError(test::runProgram(kName, {"--output", page()}), 2, kName, {"--scene", "--input"});
    expectError(test::runProgram(kName, {"--scene", result() + "/map.ply", "--output", page()}), 2, kName,
                {"--input"});
    expectError(
        test::runProgram(kName, {"--input", result(), "--output", folder_ / "a.png", "--max-size", "3"}), 2,
        kName, {"--max-size", ".html"});
    EXPECT_FALSE(fs::exists(page()));

    expectError(test::runProgram(kName, {"--input", result(), "--output", folder_ / "no/such/x.html"}), 1,
                kName, {"cannot write", "x.html"});
    fs::create_directories(folder_ / "taken.html");
    expectError(test::runProgram(kName, {"--input", result(), "--output", folder_ / "taken.html"}), 1, kName,
                {"taken.html", "it is a folder"});
    const std::string pipe = folder_ / "pipe.html";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expectError(test::runForSeconds(20, kName, {"--input", result(), "--output", pipe}), 1, kName,
                {"it is a pipe"});
}

TEST_F(RenderPage, DamagedFilesAreNamed) {
    const std::string ply = result() + "/map.ply", whole = test::readFile(ply);
    const auto expectFault = [&](const std::string& bytes, const std::string& why) {
        test::writeFile(ply, bytes);
        expectError(render(), 1, kName, {"map.ply", why});
    };
    expectFault("", "head of a binary PLY");
    expectFault(whole.substr(0, whole.size() - 5), "cut off");
    expectFault(whole + "more", "cut off");
    const std::size_t edge = whole.find("property int edge");
    expectFault(std::string(whole).replace(edge, 17, "property int egde"), "no 'int edge'");
    expectFault(std::string(whole).replace(whole.find("float x"), 7, "short x"), "'property short x'");
    expectFault(std::string(whole).replace(whole.find("vertex 1"), 8, "vertex -"), "'element vertex -");
    std::string not_finite = whole;
    const float nan = std::nanf("");
    std::memcpy(&not_finite[whole.find("end_header\n") + 11 + 28 * 3], &nan, 4);
    expectFault(not_finite, "point 3 is not finite");
    test::writeFile(ply, whole);
    test::writeFile(result() + "/summary.json", "{\"input\":");
    expectError(render(), 1, kName, {"summary.json"});
    test::writeFile(result() + "/summary.json", "{\"input\": {\"path\": 3}}");
    expectError(render(), 1, kName, {"summary.json"});
    writeSummary();
    test::writeFile(result() + "/keyframes.txt", "1 2 3\n");
    expectError(render(), 1, kName, {"keyframes.txt:1:"});
    EXPECT_FALSE(fs::exists(page()));
}

}  // namespace
}  // namespace roevo
