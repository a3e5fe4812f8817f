/// Figures of a report, by the paths that gnuplot draws.
#include <gtest/gtest.h>

#include <regex>

#include "programs/process.h"
#include "report_fixture.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

using test::makeRun;
using test::makeSequence;

// Px, y downwards.
struct Point {
    double x = 0, y = 0;
};

// The pieces of a figure's n-th line, counted from 1.
std::vector<std::vector<Point>> piecesOf(const Figure& figure, int line) {
    std::string svg = figure.svg;
    const std::size_t begin = svg.find("gnuplot_plot_" + std::to_string(line) + "\"");
    if (begin == std::string::npos) return {};
    svg = svg.substr(begin, svg.find("gnuplot_plot_" + std::to_string(line + 1) + "\"") - begin);
    const std::size_t path = svg.find(" d='");
    svg = svg.substr(path, svg.find("'", path + 4) - path);
    std::vector<std::vector<Point>> pieces;
    const std::regex step(R"(([ML])?\s*([-0-9.]+),([-0-9.]+))");
    for (std::sregex_iterator at(svg.begin(), svg.end(), step), end; at != end; ++at) {
        if ((*at)[1] == "M") pieces.emplace_back();
        pieces.back().push_back({std::stod((*at)[2]), std::stod((*at)[3])});
    }
    return pieces;
}

class Plots : public testing::Test {
  protected:
    void SetUp() override {
        if (findProgram("gnuplot").empty()) GTEST_SKIP() << "no gnuplot";
    }
    // A walk of 100 poses, 10 Hz, in which the first ones are missing or wrong.
    static std::vector<StampedPose> walk() {
        std::vector<StampedPose> poses;
        for (int i = 0; i < 100; ++i)
            poses.push_back({0.1 * i, Pose(Eigen::Translation3d(0.02 * i, std::sin(0.1 * i), 0))});
        return poses;
    }
    void add(const std::string& name, std::vector<StampedPose> poses) {
        MethodRun run = makeRun(name, 0);
        run.trajectory = std::move(poses);
        sequence_.runs.push_back(run);
    }
    SequenceResults results() {
        sequence_.reference = walk();
        return {&sequence_, evaluateRuns(sequence_)};
    }
    static Legend legendOf(const SequenceResults& results) {
        Legend legend{tableMethods({results}), {}};
        legend.styles = lineStyles(legend.methods);
        return legend;
    }

    SequenceComparison sequence_ = makeSequence("s", {});
};

TEST_F(Plots, TheCumulativeCurveRisesWhereTheErrorsAre) {
    // Up and down by 1 cm and, in the second half, by 4 cm: no alignment makes either smaller by more than a
    // little
    auto poses = walk();
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i].T_world_camera.translation().z() += (i % 2 ? 1 : -1) * (i < 50 ? 0.01 : 0.04);
    add("a", poses);
    const SequenceResults r = results();
    const auto pieces = piecesOf(cumulativeErrorFigure(r, legendOf(r)), 1);
    ASSERT_EQ(pieces.size(), 1u);
    const auto& curve = pieces[0];
    for (std::size_t i = 1; i < curve.size(); ++i) {
        EXPECT_GE(curve[i].x, curve[i - 1].x);
        EXPECT_LE(curve[i].y, curve[i - 1].y);
    }
    // Half of the poses left of the middle, between the errors, and the way from 1 to 4 cm without a step
    // upwards
    double widest = 0, level = 0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        if (curve[i].x - curve[i - 1].x > widest) {
            widest = curve[i].x - curve[i - 1].x;
            level = (curve[i - 1].y + curve[i].y) / 2;
        }
    const double bottom = curve.front().y, top = curve.back().y;
    EXPECT_LT(top, 45) << "all of the poses are at the top of 300 px";
    EXPECT_GT(widest, 0.5 * (curve.back().x - curve.front().x));
    EXPECT_NEAR((bottom - level) / (bottom - top), 0.5, 0.02);
}

TEST_F(Plots, LinesEndWhereNothingIsKnown) {
    auto poses = walk();
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i].T_world_camera.translation().z() += i % 3 ? 0.01 : -0.01;
    add("whole", poses);
    poses.erase(poses.begin() + 40, poses.begin() + 70);
    add("gap", poses);
    const SequenceResults r = results();
    const Legend legend = legendOf(r);
    const Figure errors = errorFigure(r, legend), above = trajectoryFigures(r, legend).at(0);
    // Lines leave the picture below, too; the middle of the gap is what tells
    const auto whole = piecesOf(errors, 1);
    const double middle =
        whole.front().front().x + 5.45 / 9.9 * (whole.back().back().x - whole.front().front().x);
    const auto crosses = [&](const std::vector<Point>& piece) {
        return piece.front().x < middle && middle < piece.back().x;
    };
    const auto gap = piecesOf(errors, 2);
    EXPECT_TRUE(std::any_of(whole.begin(), whole.end(), crosses));
    EXPECT_FALSE(std::any_of(gap.begin(), gap.end(), crosses));
    EXPECT_LT(gap.front().front().x, middle);
    EXPECT_GT(gap.back().back().x, middle);
    EXPECT_EQ(piecesOf(above, 1).size(), 1u) << "the ground truth";
    EXPECT_EQ(piecesOf(above, 2).size(), 1u);
    EXPECT_EQ(piecesOf(above, 3).size(), 2u);
}

}  // namespace
}  // namespace roevo
