#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>

#include "programs/gnuplot.h"
#include "programs/interrupt.h"
#include "support/environment.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::readFile;
using test::TemporaryFolder;

// What drawSvg() throws; empty when it does not.
std::string complaint(const std::string& path, const std::string& script) {
    try {
        drawSvg(path, script);
    } catch (const std::exception& e) {
        return e.what();
    }
    return {};
}

bool isEmpty(const TemporaryFolder& folder) {
    return std::filesystem::is_empty(folder.path());
}

TEST(Gnuplot, DrawsDataWithGapsAndAnyText) {
    const TemporaryFolder folder;
    const std::string name = "a_b's {x} & <y> ^ @ ~ \\ %";
    drawSvg(folder / "plot.svg",
            gnuplotData("data", {{0, 1}, {1, std::nan("")}, {2, 3}}) + "plot $data with linespoints title " +
                gnuplotText(name),
            400, 300);
    const std::string svg = readFile(folder / "plot.svg");
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("width=\"400\" height=\"300\""), std::string::npos);
    EXPECT_NE(svg.find("a_b's {x} &amp; &lt;y> ^ @ ~ \\ %"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("baseline-shift"), std::string::npos) << "text was taken for a formula";
}

TEST(Gnuplot, ALineEndsAtANumberThatIsNone) {
    const TemporaryFolder folder;
    drawSvg(folder / "plot.svg",
            gnuplotData(
                "data",
                {{0, 1}, {1, 2}, {std::nan(""), std::nan("")}, {2, 1}, {3, std::nan("")}, {4, 1}, {5, 2}}) +
                "unset key\nplot $data using 1:2 with lines");
    std::string svg = readFile(folder / "plot.svg");
    svg = svg.substr(svg.find("gnuplot_plot_1"));
    const std::size_t path = svg.find(" d='");
    svg = svg.substr(path, svg.find("'", path + 4) - path);
    EXPECT_GE(std::count(svg.begin(), svg.end(), 'M'), 2) << svg;
    EXPECT_EQ(std::count(svg.begin(), svg.end(), 'L'), 2) << "two pieces of two points: " << svg;
}

TEST(Gnuplot, TheSameInputGivesTheSameBytes) {
    const TemporaryFolder folder;
    for (const char* name : {"a.svg", "b.svg"}) drawSvg(folder / name, "plot x");
    EXPECT_EQ(readFile(folder / "a.svg"), readFile(folder / "b.svg"));
}

TEST(Gnuplot, FaultsAreOneLineAndLeaveNothingBehind) {
    const TemporaryFolder folder;
    for (const char* script :
         {"plot no_such_function(x)", "plot $nothing with lines", "plot '", "set title 'no plot'"}) {
        const std::string text = complaint(folder / "plot.svg", script);
        EXPECT_NE(text.find("plot.svg: gnuplot"), std::string::npos) << script << ": " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_TRUE(isEmpty(folder)) << script;
    }
    const std::string text = complaint(folder / "missing/plot.svg", "plot x");
    EXPECT_NE(text.find("missing/plot.svg: No such file"), std::string::npos) << text;
}

TEST(Gnuplot, TheUsersOwnSettingsDoNotCount) {
    const TemporaryFolder folder;
    drawSvg(folder / "plain.svg", "plot x");
    test::writeFile(folder / ".gnuplot", "set title 'mine'\nset border 0\n");
    const test::WithEnvironment with("HOME", folder.path().string());
    drawSvg(folder / "plot.svg", "plot x");
    EXPECT_EQ(readFile(folder / "plot.svg"), readFile(folder / "plain.svg"));
}

TEST(Gnuplot, IsEndedByAnInterrupt) {
    const TemporaryFolder folder;
    const InterruptGuard guard;
    raise(SIGINT);
    EXPECT_THROW(drawSvg(folder / "plot.svg", "pause 100"), Interrupted);
    EXPECT_TRUE(isEmpty(folder));
}

TEST(Gnuplot, IsMissed) {
    const TemporaryFolder folder, empty;
    const test::WithEnvironment with("PATH", empty.path().string());
    const std::string text = complaint(folder / "plot.svg", "plot x");
    EXPECT_NE(text.find("plot.svg: gnuplot is not installed"), std::string::npos) << text;
    EXPECT_TRUE(isEmpty(folder));
}

}  // namespace
}  // namespace roevo
