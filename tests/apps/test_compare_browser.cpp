// A report as it stands on a disk: its 3-D view, its figures as files, and how it looks on screens of three
// widths.
#include <filesystem>

#include "browser.h"
#include "compare_program.h"
#include "web_page.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kLongName = "x<y_with_a_name_that_is_as_long_as_names_may_be_at_all_here_";

class CompareReportFiles : public test::CompareProgram {
  protected:
    void compare() const {
        const std::string input = clip("a clip", 32);
        fs::copy_file(input + "/groundtruth.txt", folder / "given.txt");
        const auto result = run({input}, {"--methods", "roevo-ba,roevo-tr", "--trajectory",
                                          kLongName + "=" + (folder / "given.txt")});
        ASSERT_EQ(result.exit_code, 0) << result.all();
    }
};

TEST_F(CompareReportFiles, ViewAndFiguresLieBesideIt) {
    compare();
    const std::string html = test::readFile(output() + "/report.html");
    EXPECT_NE(html.find("href=\"views/a_clip.html\""), std::string::npos);
    const json view = test::dataOf(test::readFile(output() + "/views/a_clip.html"));
    ASSERT_TRUE(view.is_object());
    EXPECT_EQ(view["title"], "a clip");
    std::vector<std::string> names, roles;
    for (const json& path : view["paths"]) {
        names.push_back(path["name"]);
        roles.push_back(path["role"]);
        EXPECT_EQ(path["count"], 32) << path["name"];
    }
    EXPECT_EQ(names, (std::vector<std::string>{"ROEVO TR+BA", "ROEVO TR", kLongName, "ground truth"}));
    EXPECT_EQ(roles, (std::vector<std::string>{"final", "other", "other", "truth"}));
    EXPECT_NEAR(view["paths"][2]["ate"].get<double>(), 0, 1e-6) << "the ground truth itself";
    EXPECT_GT(test::pointsOf(test::layerOf(view, "edges")).size(), 100u);
    EXPECT_GT(view["keyframes"]["count"], 0);
    EXPECT_TRUE(view["corners"].is_array()) << "the camera's shape";

    std::size_t figures = 0;
    for (const auto& file : fs::directory_iterator(output() + "/figures")) {
        const std::string name = file.path().filename(), svg = test::readFile(file.path());
        ++figures;
        EXPECT_NE(html.find("href=\"figures/" + name + "\""), std::string::npos) << name;
        for (const char* part : {"ROEVO TR+BA", "x&lt;y_with", "xmlns=\"http://www.w3.org/2000/svg\""})
            if (name != "a_clip_time_per_frame_by_stage.svg") {
                EXPECT_NE(svg.find(part), std::string::npos) << part << " in " << name;
            }
        const auto parsed = test::runProgram(
            "/usr/bin/python3",
            {"-c", "import sys, xml.etree.ElementTree as E; E.parse(sys.argv[1])", file.path()});
        EXPECT_EQ(parsed.exit_code, 0) << name << parsed.err;
    }
    EXPECT_EQ(figures, 9u) << "2 of trajectories, 4 of errors, 2 over path length, times";
}

TEST_F(CompareReportFiles, FitsEveryScreen) {
    if (findProgram("chromium").empty()) GTEST_SKIP() << "no chromium here (apt-get install chromium)";
    compare();
    const std::string user = test::readFile(ROEVO_SOURCE_DIR "/tests/apps/report_user.js");
    test::writeFile(
        folder / "screens.html",
        "<!DOCTYPE html><meta charset=\"utf-8\"><body><script>const report_address = 'out/report.html';\n" +
            test::kTell + user + "</script></body>");
    const json found = test::foundInBrowser(folder / "screens.html", folder / "profile");
    if (found.is_null()) return;
    for (const char* width : {"1280", "800", "390"}) {
        ASSERT_TRUE(found.contains(width)) << found;
        const json& of = found[width];
        EXPECT_LE(of["overflow"], 0) << width << ": the page has a scroll bar below";
        for (const char* list : {"beyond", "hidden", "cut", "loaded"})
            EXPECT_EQ(of[list], json::array()) << width << ": " << list;
        EXPECT_GE(of["smallest"], 8) << width << ": px of a text in a plot";
        EXPECT_EQ(of["plots"], 9) << width;
        EXPECT_EQ(of["files"].size(), 9u) << width;
        for (const json& file : of["files"])
            EXPECT_TRUE(fs::exists(file.get<std::string>().substr(7))) << "file://: " << file;
        ASSERT_EQ(of["views"].size(), 1u) << width;
        EXPECT_LE(of["view_overflow"], 0) << width;
        if (of["webgl"]) {
            EXPECT_GT(of["drawn"], 300) << width << ": pixels of the view";
        }
    }
}

}  // namespace
}  // namespace roevo
