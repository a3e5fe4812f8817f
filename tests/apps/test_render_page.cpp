#include <sys/stat.h>

#include <cmath>
#include <regex>

#include "evaluation/trajectory_io.h"
#include "programs/process.h"
#include "roevo_mrpt/scene_builder.h"
#include "web_page.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::expectError;

constexpr char kName[] = "roevo-render";
constexpr Rgb kMagenta{250, 30, 250};

// A circle in the plane y = 0, as a camera that turns with it would walk it.
std::vector<StampedPose> circle(double radius) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < 60; ++i) {
        const double angle = 2 * kPi * i / 60;
        poses.push_back(
            {100 + 0.1 * i, Pose(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY())),
                                 {radius * std::sin(angle), 0, radius * std::cos(angle)})});
    }
    return poses;
}

std::vector<StampedPose> moved(const Pose& T, std::vector<StampedPose> poses) {
    for (StampedPose& pose : poses) pose.T_world_camera = T * pose.T_world_camera;
    return poses;
}

const Pose kElsewhere(Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized())),
                      {5, -7, 2});

MapEdge lineOf(const Eigen::Vector3f& from, const Eigen::Vector3f& to, int points) {
    MapEdge edge;
    for (int i = 0; i < points; ++i) {
        edge.points.push_back(from + (to - from) * static_cast<float>(i) / static_cast<float>(points - 1));
        edge.colours.push_back(kMagenta);
    }
    return edge;
}

/// A result folder as roevo-odometry leaves it: a circle of radius 1 in a room.
class RenderPage : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(result());
        writeTumTrajectory(result() + "/trajectory.txt", circle(1));
        writeTumTrajectory(result() + "/trajectory_live.txt", circle(1.02));
        writeTumTrajectory(result() + "/keyframes.txt", {circle(1)[0], circle(1)[20]});
        for (const float y : {-1.2f, 1.2f})
            for (const float x : {-2.f, 2.f}) {
                map_.push_back(lineOf({x, y, -2}, {x, y, 2}, 200));
                map_.push_back(lineOf({-2, y, x}, {2, y, x}, 150));
            }
        map_.push_back(lineOf({0, 0, 500}, {0.1f, 0, 500}, 10));  // far off: it may not spoil the others
        savePly(result() + "/map.ply", map_);
        for (int i = 0; i < 3000; ++i)
            surface_.push_back(
                {{2 * std::sin(0.01f * static_cast<float>(i)), 1.f, 0.001f * static_cast<float>(i)},
                 {static_cast<std::uint8_t>(i % 256), 7, 200}});
        savePointsPly(result() + "/map_semi_dense.ply", surface_);
        writeSummary("");
    }

    void writeSummary(const std::string& ground_truth) const {
        json summary = {{"input", {{"path", "data/some room/"}}}, {"mode", "ba"}};
        summary["camera"] = {{"width", 640}, {"height", 480}, {"fx", 525},
                             {"fy", 525},    {"cx", 319.5},   {"cy", 239.5}};
        summary["ground_truth"] = ground_truth.empty() ? json() : json{{"file", ground_truth}};
        test::writeFile(result() + "/summary.json", summary.dump());
    }

    std::string result() const { return folder_ / "result"; }
    std::string page() const { return folder_ / "view.html"; }

    test::ProgramResult render(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--input", result(), "--output", page()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kName, arguments);
    }

    json data() const { return test::dataOf(test::readFile(page())); }

    test::TemporaryFolder folder_;
    EdgeMap map_;
    std::vector<ColouredPoint> surface_;
};

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
            EXPECT_EQ(edges[i].colour[0], kMagenta[0]);
            EXPECT_EQ(edges[i].colour[1], kMagenta[1]);
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

TEST_F(RenderPage, AlignsAllWithTheGroundTruth) {
    // A circle within a larger one: no motion brings them nearer, and every pose errs by the difference
    writeTumTrajectory(folder_ / "truth.txt", moved(kElsewhere, circle(1.1)));
    writeTumTrajectory(folder_ / "other.txt", moved(kElsewhere.inverse(), circle(1.25)));
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
        const auto truth = circle(radius[p]);
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

TEST_F(RenderPage, TakesTheGroundTruthOfTheRunOrGoesWithout) {
    writeTumTrajectory(folder_ / "truth.txt", circle(1.1));
    writeSummary(folder_ / "truth.txt");
    ASSERT_EQ(render().exit_code, 0);
    EXPECT_EQ(data()["paths"].size(), 3u);

    fs::remove(folder_ / "truth.txt");
    writeTumTrajectory(folder_ / "other.txt", moved(kElsewhere, circle(1.25)));
    const auto run = render({"--trajectory", "other=" + (folder_ / "other.txt")});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    EXPECT_NE(run.err.find("truth.txt"), std::string::npos) << run.err;
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
    writeTumTrajectory(folder_ / "other.txt", circle(1));
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
        map_.push_back(lineOf({0, y, 1}, {2, y, 1}, 200));
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
    expectError(with(result(), {"--trajectory", "=" + (folder_ / "late.txt")}), 2, kName, {"no name"});
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
    writeSummary("");
    test::writeFile(result() + "/keyframes.txt", "1 2 3\n");
    expectError(render(), 1, kName, {"keyframes.txt:1:"});
    EXPECT_FALSE(fs::exists(page()));
}

// Put at the end of the page: uses it as a user would and counts pixels after each step.
constexpr char kUser[] = R"js(<script>
(async function () {
    const canvas = document.getElementById('canvas'), flat = document.createElement('canvas');
    const found = {};
    // The page draws in the animation frame that an event asks for; ours comes after it in the same one
    const pixels = () => new Promise(done => {
        dispatchEvent(new Event('resize'));
        requestAnimationFrame(() => {
            [flat.width, flat.height] = [canvas.width, canvas.height];
            const context = flat.getContext('2d');
            context.drawImage(canvas, 0, 0);
            done(context.getImageData(0, 0, flat.width, flat.height).data);
        });
    });
    const count = (data, is) => {
        let n = 0;
        for (let i = 0; i < data.length; i += 4) n += is(data[i], data[i + 1], data[i + 2]);
        return n;
    };
    const magenta = (r, g, b) => r > 110 && b > 110 && g < 0.6 * r, orange = (r, g, b) => r > 180 && g > 0.38 * r && g < 0.6 * r && b < 0.5 * r;
    const box = id => document.querySelector('input[data-item="' + id + '"]');
    const differing = (a, b) => count(a.map((v, i) => Math.abs(v - b[i])), (r, g, b) => r + g + b > 60);
    const mouse = (type, x, y, target) => target.dispatchEvent(new MouseEvent(type, {clientX: x, clientY: y, button: 0, bubbles: true}));
    const touch = (type, x, y) => canvas.dispatchEvent(new TouchEvent(type, {bubbles: true, cancelable: true,
        touches: [new Touch({identifier: 1, target: canvas, clientX: x, clientY: y, pageX: x, pageY: y})]}));

    let now = await pixels();
    found.edges = count(now, magenta);
    found.path = count(now, orange);
    box('edges').click();
    found.hidden = count(await pixels(), magenta);
    box('edges').click();
    found.shown = count(await pixels(), magenta);
    document.querySelector('input[value=error]').click();
    found.path_by_error = count(await pixels(), orange);
    document.querySelector('input[value=name]').click();

    mouse('mousedown', 500, 300, canvas), mouse('mousemove', 560, 330, document), mouse('mouseup', 560, 330, document);
    let before = now;
    now = await pixels();
    found.turned = differing(before, now);
    canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true}));
    before = now;
    now = await pixels();
    found.zoomed = differing(before, now);
    touch('touchstart', 500, 300), touch('touchmove', 400, 300), touch('touchend', 400, 300);
    before = now;
    now = await pixels();
    found.touched = differing(before, now);
    box('live').focus();
    const slider = document.getElementById('time-slider');
    slider.value = 30;
    slider.dispatchEvent(new Event('input'));
    found.moment = document.getElementById('time-text').textContent;
    found.names = [...document.querySelectorAll('#path-list .name')].map(e => e.textContent);
    found.loaded = performance.getEntriesByType('resource').length;
    found.overflow = document.documentElement.scrollWidth - innerWidth;
    const result = document.body.appendChild(document.createElement('pre'));
    result.id = 'found';
    result.textContent = JSON.stringify(found);
})();
</script></body>)js";

TEST_F(RenderPage, WorksInABrowser) {
    const std::string chromium = findProgram("chromium");
    if (chromium.empty())
        GTEST_SKIP() << "no chromium here (apt-get install chromium): the page is not tried in a browser";
    writeTumTrajectory(folder_ / "truth.txt", circle(1.1));
    writeTumTrajectory(folder_ / "other.txt", circle(1.3));
    ASSERT_EQ(
        render({"--ground-truth", folder_ / "truth.txt", "--trajectory", "</b>x=" + (folder_ / "other.txt")})
            .exit_code,
        0);
    std::string html = test::readFile(page());
    html.replace(html.rfind("</body>"), 7, kUser);
    test::writeFile(page(), html);
    const auto run = test::runProgram(
        "/usr/bin/timeout",
        {"60", chromium, "--headless", "--no-sandbox", "--enable-unsafe-swiftshader",
         "--use-angle=swiftshader", "--user-data-dir=" + (folder_ / "profile"), "--window-size=800,600",
         "--virtual-time-budget=5000", "--dump-dom", "file://" + page()});
    const std::string begin = "<pre id=\"found\">";
    const std::size_t at = run.out.find(begin);
    ASSERT_NE(at, std::string::npos) << "the page did not come to its end: " << run.err;
    const json found =
        json::parse(run.out.substr(at + begin.size(), run.out.find("</pre>", at) - at - begin.size()));
    const auto number = [&](const char* key) { return found[key].get<int>(); };
    EXPECT_GT(number("edges"), 300) << found;
    EXPECT_GT(number("path"), 50) << found;
    EXPECT_EQ(number("hidden"), 0) << found;
    EXPECT_EQ(number("shown"), number("edges")) << found;
    EXPECT_LT(number("path_by_error"), number("path") / 5) << found;
    for (const char* step : {"turned", "zoomed", "touched"}) EXPECT_GT(number(step), 300) << step << found;
    EXPECT_EQ(found["moment"], "3.00 s · error 10 cm");
    EXPECT_EQ(found["names"], json({"final", "live", "&lt;/b&gt;x", "ground truth"}))
        << "text, as dump-dom escapes it";
    EXPECT_EQ(number("loaded"), 0) << found;
    EXPECT_LE(number("overflow"), 0) << found;
}

}  // namespace
}  // namespace roevo
