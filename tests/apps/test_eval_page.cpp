#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "evaluation/trajectory_io.h"
#include "programs/process.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::expectError;

constexpr char kName[] = "roevo-eval";

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
    return found;
}

/// A reference and an estimate that goes up and down by 1 cm beside it, at half the size.
class EvalPage : public ::testing::Test {
  protected:
    EvalPage() {
        std::vector<StampedPose> poses;
        for (int i = 0; i < 80; ++i)
            poses.push_back({0.1 * i, Pose(Eigen::Translation3d(std::cos(0.1 * i), std::sin(0.1 * i), 0))});
        writeTumTrajectory(folder_ / "truth.txt", poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            poses[i].T_world_camera.translation().z() += i % 2 ? 0.01 : -0.01;
            poses[i].T_world_camera.translation() *= 0.5;
        }
        writeTumTrajectory(folder_ / "half.txt", poses);
    }
    std::vector<std::string> arguments(std::vector<std::string> more) const {
        std::vector<std::string> all{"--reference", folder_ / "truth.txt", "--estimate", folder_ / "half.txt",
                                     "<b>&\"half\"=" + (folder_ / "half.txt")};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    test::ProgramResult eval(const std::vector<std::string>& more) const {
        return test::runProgram(kName, arguments(more));
    }

    test::TemporaryFolder folder_;
};

TEST_F(EvalPage, HasTableAndFiguresAndNeedsNothingElse) {
    if (findProgram("gnuplot").empty()) GTEST_SKIP() << "no gnuplot";
    const auto run = eval({"--align", "sim3", "--plot", folder_ / "p.html"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const std::string page = test::readFile(folder_ / "p.html");
    EXPECT_EQ(count(page, "class=\"plot\""), 8u)
        << "top, side; position, axes, angle, cumulative; translation and rotation over path length";
    EXPECT_EQ(count(page, "<td class=\"best\">1.000</td>"), 4u) << "rmse and mean of both, in cm";
    EXPECT_EQ(count(page, "<td>1.9998</td>"), 2u) << "the scale, made a little less by the noise";
    EXPECT_NE(page.find("&lt;b&gt;&amp;&quot;half&quot;"), std::string::npos) << "a name as it is";
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    // The estimate as it is aligned: scaled, so that it stays in the picture of the reference
    EXPECT_EQ(page.find("Leaving the picture"), std::string::npos);
    for (const char* fetched : {"<script", "<link", "<img", " src=", "@import", "url(http", "href=\"http"})
        EXPECT_EQ(page.find(fetched), std::string::npos) << fetched;
    const std::string python = "/usr/bin/python3";
    if (!std::filesystem::exists(python)) GTEST_SKIP() << "no " << python;
    const auto parsed = test::runProgram(
        python, {"-c", "import sys, xml.etree.ElementTree as E; E.parse(sys.argv[1])", folder_ / "p.html"});
    EXPECT_EQ(parsed.exit_code, 0) << parsed.all();
}

TEST_F(EvalPage, IsTheSameEachTime) {
    if (findProgram("gnuplot").empty()) GTEST_SKIP() << "no gnuplot";
    for (const char* name : {"a.html", "b.html"}) eval({"--plot", folder_ / name});
    EXPECT_FALSE(test::readFile(folder_ / "a.html").empty());
    EXPECT_EQ(test::readFile(folder_ / "a.html"), test::readFile(folder_ / "b.html"));
}

TEST_F(EvalPage, FailuresAreOneLineAndLeaveNothing) {
    expectError(eval({"--plot", folder_ / "p.pdf"}), 2, kName, {"--plot", ".html"});
    auto words = arguments({"--plot", folder_ / "p.html", "--table", folder_ / "t.csv"});
    words.insert(words.begin(), {"PATH=/nowhere", std::string(ROEVO_BIN_DIR) + "/" + kName});
    expectError(test::runProgram("/usr/bin/env", words), 1, kName, {"gnuplot is not installed"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "p.html"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "t.csv"));
    if (findProgram("gnuplot").empty()) return;
    expectError(eval({"--plot", folder_ / "no/p.html"}), 1, kName, {"cannot write", "p.html"});
}

}  // namespace
}  // namespace roevo
