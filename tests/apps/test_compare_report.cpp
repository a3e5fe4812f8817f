// report.html: well-formed, nothing to be loaded, plots and pictures or the reason why there are none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "programs/interrupt.h"
#include "programs/process.h"
#include "programs/text.h"
#include "report_fixture.h"
#include "roevo-compare/report/line_style.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/scene_picture.h"
#include "support/environment.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

using test::contains;
using test::count;
using test::failedRun;
using test::makeInfo;
using test::makeRun;
using test::makeSequence;
using test::skippedRun;
using test::TemporaryFolder;
using test::WrittenComparison;

// An XML parser takes the page: tags are closed, text is escaped, ids are there once.
class WellFormedReport : public testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(test::kPython)) GTEST_SKIP() << "no " << test::kPython;
    }
    static void expectWellFormed(const WrittenComparison& out) {
        const auto result = test::runProgram(
            test::kPython, {"-c",
                            "import sys, collections, xml.etree.ElementTree as E\n"
                            "ids = [e.get('id') for e in E.parse(sys.argv[1]).iter() if e.get('id')]\n"
                            "twice = [i for i, n in collections.Counter(ids).items() if n > 1]\n"
                            "sys.exit(f'twice: {twice}' if twice else 0)\n",
                            out.path("report.html")});
        EXPECT_EQ(result.exit_code, 0) << result.all();
    }
};

// What a browser would fetch to show the page; links that a reader may follow are none of it.
std::vector<std::string> loadedBy(std::string html) {
    for (std::size_t at = 0; (at = html.find(";base64,", at)) != std::string::npos; ++at)
        html.erase(at, html.find('"', at) - at);  // std::regex runs out of stack over a picture
    const std::regex attribute(
        R"re(\s(src|srcset|data|poster|background|xlink:href)\s*=\s*["']?([^"'\s>]*))re"),
        style(R"re(url\(\s*['"]?([^'")]*))re"),
        element(R"re(<(script|link|iframe|object|embed|base|audio|video)\b|@import)re");
    std::vector<std::string> loaded;
    const auto add = [&](const std::regex& pattern, std::size_t group) {
        for (std::sregex_iterator at(html.begin(), html.end(), pattern), end; at != end; ++at) {
            const std::string target = (*at)[group].str();
            if (target.rfind("data:", 0) != 0 && target.rfind('#', 0) != 0) loaded.push_back(at->str());
        }
    };
    add(attribute, 2);
    add(style, 1);
    add(element, 0);
    return loaded;
}

TEST(LoadedBy, FindsWhatABrowserWouldFetch) {
    for (const char* page :
         {"<img src=\"plot.png\"/>", "<img alt='a' src='runs/map.png'/>", "<img src=plot.png>",
          "<img src=\"https://a.b/c.png\"/>", "<image xlink:href=\"a.png\"/>", "<script>1</script>",
          "<link rel=\"stylesheet\" href=\"a.css\"/>", "<p style=\"background: url(a.png)\">",
          "<style>@import 'a.css';</style>", "<iframe>", "<use xlink:href=\"other.svg#a\"/>"})
        EXPECT_EQ(loadedBy(page).size(), 1u) << page;
    for (const char* page : {"<img src=\"data:image/png;base64,AA==\"/>", "<a href=\"runs/a\">",
                             "<use xlink:href=\"#p1_a\"/>", "<g clip-path='url(#a)'>", "<p>src=a</p>"})
        EXPECT_EQ(loadedBy(page), std::vector<std::string>()) << page;
}

void expectNoBadNumber(const WrittenComparison& out) {
    const std::regex bad(R"((^|[^A-Za-z])(nan|inf|infinity)([^A-Za-z]|$))", std::regex::icase);
    for (const std::string* text : {&out.csv, &out.md, &out.html}) {
        std::smatch match;
        EXPECT_FALSE(std::regex_search(*text, match, bad)) << match.prefix().str().substr(
            match.prefix().length() > 200 ? static_cast<std::size_t>(match.prefix().length()) - 200 : 0);
    }
}

std::vector<SequenceComparison> everyKind() {
    auto lost = makeRun("lost", 0.001);
    lost.tracked = 2;
    auto broken = makeRun("broken", 0.01);
    broken.trajectory[1].T_world_camera.translation().x() = std::nan("");
    broken.total.p95 = INFINITY;
    auto far = makeRun("far", 0.02);
    far.label = "Runaway";
    far.trajectory[3].T_world_camera.translation().x() += 500;
    auto mapped = makeRun("roevo-ba", 0.002);
    // In a world of its own: only aligned does it come into the picture
    for (StampedPose& pose : mapped.trajectory)
        pose.T_world_camera = Pose(Eigen::Translation3d(100, -50, 20) *
                                   Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized())) *
                              pose.T_world_camera;
    mapped.scene = "map.3Dscene";
    std::vector<SequenceComparison> all{
        makeSequence("every/kind", {makeRun("roevo-tr", 0.01), mapped, lost, broken, far,
                                    failedRun("f", "it <threw> & \"died\""), skippedRun("l", "no library")}),
        makeSequence("<odd> & \"name\", 'ü' \x01 \xff", {makeRun("roevo-tr", 0)}),
        makeSequence("one frame", {makeRun("roevo-tr", 0)}),
        makeSequence("no truth", {makeRun("roevo-tr", 0.01)}),
        makeSequence("failed", {}),
        makeSequence("elsewhere", {makeRun("roevo-tr", 0.01)})};
    all[0].run_folders.assign(7, "runs/a b/ü");
    all[2].runs[0].trajectory.resize(1);
    all[3].reference.clear();
    for (StampedPose& pose : all[5].reference) pose.timestamp += 250;
    all[4].failure = "cannot read <it>";
    return all;
}

TEST_F(WellFormedReport, WhateverIsInIt) {
    auto info = makeInfo();
    info.notes = {"runs <side> by side"};
    expectWellFormed(WrittenComparison(everyKind(), info));
}

TEST_F(WellFormedReport, WithoutGnuplot) {
    const test::WithEnvironment with("PATH", "/nowhere");
    expectWellFormed(WrittenComparison(everyKind()));
}

TEST(CompareReport, HasNothingToLoadWhateverIsInIt) {
    auto info = makeInfo();
    info.notes = {"runs <side> by side"};
    const WrittenComparison out(everyKind(), info);
    EXPECT_EQ(loadedBy(out.html), std::vector<std::string>());
    expectNoBadNumber(out);
    for (const char* words :
         {"it &lt;threw&gt; &amp; &quot;died&quot;", "&lt;odd&gt; &amp; &quot;name&quot;, &#39;ü&#39;",
          "no library", "no ground truth", "only 1 pose has", "cannot read &lt;it&gt;",
          "tracked 50.0 % of the frames only", "a pose is not a number", "a processor, 2 cores",
          "runs &lt;side&gt; by side", "roevo-compare --input &#39;a b&#39; --output out"})
        EXPECT_TRUE(contains(out.html, words)) << words;
    EXPECT_TRUE(contains(out.html, "<td class=\"best\">0.200</td>")) << "the smallest ATE of whole runs";
    EXPECT_TRUE(contains(out.html, "0.02 s")) << "the protocol";
}

TEST(CompareReport, ATableOfNothingButDashesIsASentence) {
    auto a = makeSequence("a", {makeRun("x", 0.01), makeRun("y", 0.02)}), b = a;
    b.name = "b";
    b.reference.clear();
    const WrittenComparison some({a, b});
    EXPECT_FALSE(contains(some.html, ": no figures ("));
    a.reference.clear();
    const WrittenComparison none({a, b});
    EXPECT_TRUE(contains(none.html, "<p>ATE RMSE [cm]: no figures (no ground truth)</p>"));
    EXPECT_TRUE(contains(none.html, "<h3>Time per frame, median [ms]</h3>"));
}

TEST(CompareReport, LinksRunsRelatively) {
    const TemporaryFolder folder;
    auto sequence = makeSequence("s", {makeRun("a", 0.01)});
    sequence.run_folders = {folder / "out/runs/s p/<a>&"};
    std::filesystem::create_directories(folder / "out");
    writeComparison(folder / "out", {sequence}, makeInfo());
    EXPECT_TRUE(contains(test::readFile(folder / "out/report.html"), "href=\"runs/s%20p/%3Ca%3E%26\""));
}

TEST(CompareReport, TakesThePlaceOfAnEarlierOne) {
    if (findProgram("gnuplot").empty()) GTEST_SKIP() << "no gnuplot";
    const TemporaryFolder folder;
    const std::string figures = folder / "figures/";
    std::filesystem::create_directories(folder / "pages/views");
    test::writeFile(folder / "pages/views/old.html", "a view");
    test::writeFile(folder / "pages/old.html",
                    "<h1>Comparison of RGB-D odometries</h1><a href=\"views/old.html\">");
    writeComparison(folder.path(),
                    {makeSequence("a", {makeRun("x", 0.01)}), makeSequence("b", {makeRun("x", 0.01)})},
                    makeInfo());
    for (const char* old : {"pages/old.html", "pages/views/old.html"})
        EXPECT_FALSE(std::filesystem::exists(folder / old)) << old;
    EXPECT_TRUE(std::filesystem::exists(figures + "b_time_per_frame_by_stage.svg"));
    test::writeFile(figures + "mine.svg", "a drawing of somebody");
    writeComparison(folder.path(), {makeSequence("a", {makeRun("x", 0.01)})}, makeInfo());
    for (const auto& entry : std::filesystem::directory_iterator(figures))
        EXPECT_NE(entry.path().filename().string()[0], 'b') << entry.path();
    for (const std::string& kept : {figures + "a_time_per_frame_by_stage.svg", figures + "mine.svg"})
        EXPECT_TRUE(std::filesystem::exists(kept)) << kept;
}

// Each: by the reader's name for it, at the top or with the sequence.
TEST(CompareReport, NotesAndWarningsAreThereOnce) {
    auto sequence = makeSequence("s", {makeRun("roevo-tr", 0.01), makeRun("b", 0.02), makeRun("c", 0.02)});
    sequence.notes = {"2 images had no partner", "the list says so"};
    for (MethodRun& run : sequence.runs) run.warnings = {"the file ends early"}, run.part = "frames 3 to 6";
    sequence.runs[1].warnings.push_back("no scene: disk full");
    auto info = makeInfo();
    info.notes = {"the machine was busy"};
    const WrittenComparison out({sequence}, info);
    for (const char* words :
         {"2 images had no partner", "the list says so", "s: the file ends early",
          "s: label of b: no scene: disk full", "the machine was busy",
          "Only parts of these recordings were run (counted from 0): s: frames 3 to 6."}) {
        EXPECT_EQ(count(out.html, words), 1u) << words;
        EXPECT_EQ(count(out.md, words), 1u) << words << "\n" << out.md;
    }
    EXPECT_EQ(out.row("s", "b").at("warning"), "the file ends early; no scene: disk full");
    EXPECT_EQ(out.row("s", "b").at("sequence_note"), "2 images had no partner; the list says so");
    EXPECT_EQ(out.row("s", "b").at("sequence_part"), "frames 3 to 6");
}

TEST(CompareReport, AScaleThatCannotBeRightIsToldOnceForAll) {
    std::vector<StampedPose> truth, small;
    for (int i = 0; i < 40; ++i) {
        const double angle = 0.1 * i;
        truth.push_back(
            {1000 + 0.1 * i, Pose(Eigen::Translation3d(std::cos(angle), std::sin(angle), angle))});
        small.push_back(truth.back());
        small.back().T_world_camera.translation() *= 0.5;
    }
    auto a = makeRun("a", 0), b = makeRun("b", 0), good = makeRun("good", 0);
    a.trajectory = small;
    for (StampedPose& pose : small) pose.T_world_camera.translation() *= 0.9;
    b.trajectory = small;
    good.trajectory = truth;
    auto all = makeSequence("all", {a, b}), most = makeSequence("most", {a, b, good}),
         some = makeSequence("some", {a, good});
    all.reference = most.reference = some.reference = truth;
    const WrittenComparison out({all, most, some});
    const char* words = "path is 2 times as long";
    for (const std::string* text : {&out.html, &out.md}) {
        EXPECT_EQ(count(*text, words), 2u) << "once for each sequence";
        EXPECT_TRUE(contains(*text, ">all: the ground truth") || contains(*text, "- all: the ground truth"));
        EXPECT_TRUE(contains(*text, "most: label of a, label of b: the ground truth"));
        EXPECT_FALSE(contains(*text, "some: label of a: the ground truth")) << "that is how a drifts";
    }
    EXPECT_TRUE(contains(out.row("all", "b").at("warning"), "2.2 times as long"));
    EXPECT_EQ(out.row("most", "good").at("warning"), "");
    EXPECT_EQ(out.row("some", "a").at("warning"), "");
}

TEST(CompareReport, DrawsWhatThereIs) {
    if (test::runProgram("/usr/bin/env", {"gnuplot", "--version"}).exit_code != 0)
        GTEST_SKIP() << "no gnuplot";
    const WrittenComparison out(everyKind());
    // every/kind and the odd one: top, side, four of errors, stages (too few pieces of any path length); one
    // frame, no truth and elsewhere: no error
    EXPECT_EQ(count(out.html, "class=\"plot\""), 7u + 7 + 3 + 3 + 3);
    EXPECT_EQ(count(out.html, "class=\"legend\""), 6u + 6 + 2 + 2 + 2) << "top and side share theirs";
    EXPECT_TRUE(contains(out.html, "Leaving the picture: Runaway <a")) << "and nobody else";
    EXPECT_FALSE(contains(out.html, "No plots"));
    EXPECT_TRUE(contains(out.html, "no picture: the scene map.3Dscene is missing"));
}

TEST(CompareReport, WithoutGnuplotSaysSoOnce) {
    const test::WithEnvironment with("PATH", "/nowhere");
    const WrittenComparison out(everyKind());
    EXPECT_EQ(count(out.html, "No plots: gnuplot is not installed"), 1u);
    EXPECT_EQ(count(out.html, "class=\"plot\""), 0u);
    EXPECT_TRUE(contains(out.html, "<td class=\"best\">0.200</td>"));
}

TEST(CompareReport, TheFullestModeHasTheBoldestLineInWhateverOrder) {
    const auto styleOf = [](const std::vector<std::string>& names, const char* wanted) {
        std::vector<TableMethod> methods;
        for (const std::string& name : names) methods.push_back({name, name, ""});
        const auto styles = lineStyles(methods);
        return styles[static_cast<std::size_t>(std::find(names.begin(), names.end(), wanted) -
                                               names.begin())];
    };
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"roevo-ct", "roevo-tr", "difodo-240", "roevo-ba"},
          {"roevo-ba", "difodo-240", "roevo-tr", "roevo-ct"}}) {
        EXPECT_GT(styleOf(names, "roevo-ba").width, styleOf(names, "roevo-tr").width);
        EXPECT_GT(styleOf(names, "roevo-tr").width, styleOf(names, "roevo-ct").width);
        EXPECT_EQ(
            oneRoevo({{names[0], "", ""}, {names[1], "", ""}, {names[2], "", ""}, {names[3], "", ""}}).size(),
            2u);
    }
}

// A gnuplot that fails with the first and the third of seven plots.
TEST(CompareReport, APlotThatFailsCostsOnlyThatPlot) {
    const std::string gnuplot = findProgram("gnuplot");
    if (gnuplot.empty()) GTEST_SKIP() << "no gnuplot";
    const TemporaryFolder folder;
    test::writeFile(folder / "gnuplot",
                    "#!/bin/sh\ncd " + folder.path().string() +
                        "\necho x >> calls\ncase $(wc -l < calls) in 1|3) echo 'out of ink' >&2; exit 1;; "
                        "esac\nexec " +
                        gnuplot + " \"$@\"\n");
    std::filesystem::permissions(folder / "gnuplot", std::filesystem::perms::owner_all);
    const test::WithEnvironment with("PATH", folder.path().string() + ":" + std::getenv("PATH"));
    const WrittenComparison out({makeSequence("s", {makeRun("roevo-tr", 0.01), makeRun("b", 0.02)})});
    EXPECT_EQ(count(out.html, "class=\"plot\""), 5u);
    EXPECT_TRUE(contains(out.html, "No plot (s: trajectories, Seen along y): gnuplot failed: out of ink"));
    EXPECT_TRUE(contains(out.html, "No plot (s: position error over time): gnuplot failed: out of ink"));
    EXPECT_FALSE(contains(out.html, "No plots"));
}

// The text of the drawing of stages, in which every character may stand by itself.
std::string stageDrawing(const std::vector<MethodRun>& runs) {
    const WrittenComparison out({makeSequence("s", runs)});
    const std::size_t begin = out.html.find("time per frame by stage");
    EXPECT_NE(begin, std::string::npos);
    return out.html.substr(begin, out.html.find("</figure>", begin) - begin);
}

TEST(CompareReport, MarksBeyondTheEdgeOfAPlotAreWritten) {
    if (findProgram("gnuplot").empty()) GTEST_SKIP() << "no gnuplot";
    auto outlier = makeRun("outlier", 0.01), busy = makeRun("busy", 0.01), slow = makeRun("slow", 0.01);
    outlier.total.p95 = 432.1;
    busy.cpu_ms_per_frame = 321.4;
    slow.total = {"total", 654, 765.4, 654.3};
    const std::string within = stageDrawing({makeRun("a", 0.01), makeRun("b", 0.01)});
    EXPECT_FALSE(contains(within, "▶")) << "all is drawn";
    auto twice = makeRun("twice", 0.01);
    twice.total.p95 = 13.9;
    EXPECT_FALSE(contains(stageDrawing({makeRun("a", 0.01), twice}), "▶")) << "worth a longer axis";
    const std::string drawing =
        stageDrawing({makeRun("a", 0.01), makeRun("b", 0.01), makeRun("c", 0.01), outlier, busy, slow});
    for (const char* label :
         {"mean 7.00, 95 % 432.1 ▶, processor 7.25", "mean 7.00, 95 % 9.00, processor 321.4 ▶",
          "mean 654.3 ▶, 95 % 765.4 ▶, processor 7.25"})
        EXPECT_TRUE(contains(drawing, label)) << label << "\n" << drawing;
}

TEST(CompareReport, AnInterruptEndsItAndNothingIsWritten) {
    const TemporaryFolder folder;
    const InterruptGuard guard;
    raise(SIGTERM);
    EXPECT_THROW(writeComparison(folder.path().string(), everyKind(), makeInfo()), Interrupted);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CompareReport, StatesWhatItCannotWrite) {
    try {
        writeComparison("/nowhere/at/all", {makeSequence("s", {makeRun("a", 0.01)})}, makeInfo());
        FAIL() << "should have thrown";
    } catch (const std::runtime_error& e) {
        EXPECT_TRUE(contains(e.what(), "/nowhere/at/all/table.csv")) << e.what();
        EXPECT_FALSE(contains(e.what(), "\n"));
    }
}

TEST(ScenePicture, IsDrawnByTheRendererOrSaysWhy) {
    const TemporaryFolder folder;
    test::writeFile(folder / "broken.3Dscene", "no scene");
    const Rendered broken = renderScene(folder / "broken.3Dscene", "edges");
    EXPECT_EQ(broken.bytes, "");
    EXPECT_NE(broken.fault, "");

    test::writeTumFolder(folder / "recording", test::slidingRecording(5));
    const auto run =
        test::runProgram("roevo-odometry", {"--input", folder / "recording", "--output", folder / "run"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const Rendered picture = renderScene(folder / "run/map.3Dscene", "edges");
    EXPECT_EQ(picture.fault, "");
    EXPECT_EQ(picture.bytes.substr(0, 4), "\x89PNG");
    EXPECT_NE(renderScene(folder / "run/map.3Dscene", "no-such-layer").fault, "");

    // In the page as it is
    auto sequence = makeSequence("s", {makeRun("roevo-ba", 0.01)});
    sequence.runs[0].scene = "map.3Dscene";
    sequence.run_folders = {folder / "run"};
    const WrittenComparison out({sequence});
    EXPECT_TRUE(contains(out.html, "src=\"data:image/png;base64," + base64(picture.bytes).substr(0, 40)));
    EXPECT_EQ(loadedBy(out.html), std::vector<std::string>());

    // Interrupted, it takes its folder of pictures along
    std::filesystem::create_directory(folder / "tmp");
    const test::WithEnvironment with("TMPDIR", folder / "tmp");
    {
        const InterruptGuard guard;
        raise(SIGINT);
        EXPECT_THROW(renderScene(folder / "run/map.3Dscene", "edges"), Interrupted);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp"));
}

TEST(Base64, VectorsOfTheStandard) {
    const std::pair<const char*, const char*> vectors[] = {
        {"", ""},        {"f", "Zg=="},        {"fo", "Zm8="},
        {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}};
    for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

}  // namespace
}  // namespace roevo
