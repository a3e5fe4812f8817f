// report.html: well-formed, nothing to be loaded, plots and pictures or the reason why there are none.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "report_fixture.h"
#include "roevo-compare/report/scene_picture.h"
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

constexpr char kPython[] = "/usr/bin/python3";

// An XML parser takes the page: tags are closed, text is escaped, ids are there once.
void expectWellFormed(const WrittenComparison& out) {
    if (!std::filesystem::exists(kPython)) GTEST_SKIP() << "no " << kPython;
    const auto result =
        test::runProgram(kPython, {"-c",
                                   "import sys, collections, xml.etree.ElementTree as E\n"
                                   "ids = [e.get('id') for e in E.parse(sys.argv[1]).iter() if e.get('id')]\n"
                                   "twice = [i for i, n in collections.Counter(ids).items() if n > 1]\n"
                                   "sys.exit(f'twice: {twice}' if twice else 0)\n",
                                   out.path("report.html")});
    EXPECT_EQ(result.exit_code, 0) << result.all();
}

void expectNothingToLoad(const std::string& html) {
    EXPECT_FALSE(std::regex_search(html, std::regex(R"((src|href)\s*=\s*["'](https?:)?//)")));
    EXPECT_FALSE(contains(html, "<script") || contains(html, "<link") || contains(html, "@import"));
    EXPECT_FALSE(std::regex_search(html, std::regex(R"(url\(['"]?[^#'")])")));
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
        pose.T_world_camera = Eigen::Translation3d(100, -50, 20) *
                              Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()) *
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

TEST(CompareReport, IsWellFormedWithNothingToLoadWhateverIsInIt) {
    auto info = makeInfo();
    info.notes = {"runs <side> by side"};
    const WrittenComparison out(everyKind(), info);
    expectWellFormed(out);
    expectNothingToLoad(out.html);
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

TEST(CompareReport, LinksRunsRelatively) {
    const TemporaryFolder folder;
    auto sequence = makeSequence("s", {makeRun("a", 0.01)});
    sequence.run_folders = {folder / "out/runs/s p/<a>&"};
    std::filesystem::create_directories(folder / "out");
    writeComparison(folder / "out", {sequence}, makeInfo());
    EXPECT_TRUE(contains(test::readFile(folder / "out/report.html"), "href=\"runs/s%20p/%3Ca%3E%26\""));
}

TEST(CompareReport, DrawsWhatThereIs) {
    if (test::runProgram("/usr/bin/env", {"gnuplot", "--version"}).exit_code != 0)
        GTEST_SKIP() << "no gnuplot";
    const WrittenComparison out(everyKind());
    // every/kind and the odd one: top, side, error, stages; one frame, no truth and elsewhere: no error
    EXPECT_EQ(count(out.html, "class=\"plot\""), 4u + 4 + 3 + 3 + 3);
    EXPECT_EQ(count(out.html, "class=\"legend\""), 3u + 3 + 2 + 2 + 2) << "top and side share theirs";
    EXPECT_TRUE(contains(out.html, "Leaving the picture: Runaway<")) << "and nobody else";
    EXPECT_FALSE(contains(out.html, "No plots"));
    EXPECT_TRUE(contains(out.html, "no picture: the scene map.3Dscene is missing"));
}

TEST(CompareReport, WithoutGnuplotSaysSoOnce) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    const WrittenComparison out(everyKind());
    setenv("PATH", path.c_str(), 1);
    expectWellFormed(out);
    EXPECT_EQ(count(out.html, "No plots: gnuplot is not installed"), 1u);
    EXPECT_EQ(count(out.html, "class=\"plot\""), 0u);
    EXPECT_TRUE(contains(out.html, "<td class=\"best\">0.200</td>"));
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
    const ScenePicture broken = renderScene(folder / "broken.3Dscene", "edges");
    EXPECT_EQ(broken.png, "");
    EXPECT_NE(broken.fault, "");

    test::writeTumFolder(folder / "recording", test::slidingRecording(5));
    const auto run =
        test::runProgram("roevo-odometry", {"--input", folder / "recording", "--output", folder / "run"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const ScenePicture picture = renderScene(folder / "run/map.3Dscene", "edges");
    EXPECT_EQ(picture.fault, "");
    EXPECT_EQ(picture.png.substr(0, 4), "\x89PNG");
    EXPECT_NE(renderScene(folder / "run/map.3Dscene", "no-such-layer").fault, "");

    // In the page as it is
    auto sequence = makeSequence("s", {makeRun("roevo-ba", 0.01)});
    sequence.runs[0].scene = "map.3Dscene";
    sequence.run_folders = {folder / "run"};
    const WrittenComparison out({sequence});
    EXPECT_TRUE(contains(out.html, "src=\"data:image/png;base64," + base64(picture.png).substr(0, 40)));
    expectWellFormed(out);
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
