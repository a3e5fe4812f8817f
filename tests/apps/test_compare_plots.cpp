/// Figures of a report, by the paths that gnuplot draws.
#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "programs/process.h"
#include "report_fixture.h"
#include "roevo-compare/report/distributions.h"
#include "roevo-compare/report/metrics.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

using test::count;
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

TEST_F(Plots, WhereNoErrorIsDrawnAsTheLeastOneThatIsSaid) {
    const auto notes = [&] {
        const SequenceResults r = results();
        const Legend legend = legendOf(r);
        std::string all;
        std::vector<Figure> figures = relativeErrorFigures(r, legend);
        EXPECT_EQ(figures.size(), 2u);
        figures.push_back(errorFigure(r, legend));
        figures.push_back(angularErrorFigure(r, legend));
        figures.push_back(cumulativeErrorFigure(r, legend));
        figures.push_back(boxFigure(shownMetrics()[0], {r}, legend));
        figures.push_back(cumulativeFigure(shownMetrics()[0], {r}, legend));
        for (const Figure& figure : figures) all += figure.note + '\n';
        return all;
    };
    auto poses = walk();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        Pose& pose = poses[i].T_world_camera;
        pose.translation().z() += i % 2 ? 0.01 : -0.01;
        const double turn = 0.02 + 0.01 * std::sin(0.3 * static_cast<double>(i));
        pose = pose * Pose(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    }
    add("off", poses);
    EXPECT_EQ(count(notes(), "is drawn as that"), 0u) << notes();
    add("gt", walk());
    EXPECT_EQ(count(notes(), "Less than 0.001 is drawn as that."), 5u) << notes();
    EXPECT_EQ(count(notes(), "Less than 0.0001 is drawn as that."), 2u) << notes();
}

TEST_F(Plots, ErrorsAlongTheAxesAreThoseOfTheAxes) {
    // Each zigzags along one axis only, with the same phase
    const auto addZigzag = [&](const std::string& name, int axis, double extent) {
        auto poses = walk();
        for (std::size_t i = 0; i < poses.size(); ++i)
            poses[i].T_world_camera.translation()[axis] += (i % 2 ? 1 : -1) * extent;
        add(name, poses);
    };
    addZigzag("a", 0, 0.01), addZigzag("b", 1, 0.02), addZigzag("c", 2, 0.04);
    const auto drawn = [&] {
        const SequenceResults r = results();
        return axisErrorFigure(r, legendOf(r));
    };
    EXPECT_EQ(drawn().note.find("Leaving the picture"), std::string::npos) << drawn().note;
    addZigzag("far", 0, 0.4);
    const Figure figure = drawn();
    const auto extentOf = [&](int line, char panel) {
        const std::string id = "gnuplot_plot_" + std::to_string(line) + panel;
        const std::size_t at = figure.svg.find(id + '"');
        EXPECT_NE(at, std::string::npos) << id;
        if (at == std::string::npos) return 0.;
        Figure one{"gnuplot_plot_1" + figure.svg.substr(at + id.size()), "", ""};
        double low = INFINITY, high = -INFINITY;
        for (const auto& piece : piecesOf(one, 1))
            for (const Point& point : piece) low = std::min(low, point.y), high = std::max(high, point.y);
        return high - low;
    };
    const double unit = extentOf(2, 'b');  // 4 cm, px
    EXPECT_NEAR(extentOf(3, 'c') / unit, 2, 0.2);
    EXPECT_GT(unit, 30);
    EXPECT_NEAR(extentOf(1, 'a') / unit, 0.5, 0.05);
    for (const auto& [line, panel] : {std::pair(1, 'b'), {1, 'c'}, {2, 'a'}, {2, 'c'}, {3, 'a'}, {3, 'b'}})
        EXPECT_LT(extentOf(line, panel), 0.1 * unit) << line << panel;
    EXPECT_NE(figure.note.find("Leaving the picture: label of far"), std::string::npos) << figure.note;
}

TEST_F(Plots, AnglesAndPathLengthsAreDrawn) {
    // Turned by 2 degrees from the 50th pose on; 10 % too long (the alignment has nothing to do with that)
    auto poses = walk();
    for (std::size_t i = 0; i < poses.size(); ++i)
        if (i >= 50)
            poses[i].T_world_camera =
                poses[i].T_world_camera * Pose(Eigen::AngleAxisd(2 * kPi / 180, Eigen::Vector3d::UnitX()));
    add("turned", poses);
    poses = walk();
    for (StampedPose& pose : poses) pose.T_world_camera.translation() *= 1.1;
    add("longer", poses);
    const SequenceResults r = results();
    const Legend legend = legendOf(r);
    const auto angles = piecesOf(angularErrorFigure(r, legend), 1);
    ASSERT_EQ(angles.size(), 1u);
    EXPECT_GT(angles[0].front().y - angles[0].back().y, 100) << "from nothing up to 2 degrees";
    EXPECT_NEAR(angles[0][60].y, angles[0].back().y, 1) << "and there it stays";
    EXPECT_LT(std::abs(angles[0][48].y - angles[0][51].y), angles[0].front().y - angles[0].back().y + 1);

    const auto figures = relativeErrorFigures(r, legend);
    ASSERT_EQ(figures.size(), 2u);
    const auto longer = piecesOf(figures[0], 2);
    ASSERT_EQ(longer.size(), 1u);
    EXPECT_GE(longer[0].size(), 4u) << "0.1, 0.2, 0.5, 1, 2 m of 6 m";
    EXPECT_NEAR(longer[0][2].y, longer[0][1].y, 12) << "10 % of every length that is nearly straight";
    const auto turned = piecesOf(figures[1], 1);
    ASSERT_EQ(turned.size(), 1u);
    EXPECT_GT(turned[0].back().y - turned[0].front().y, 0)
        << "one turn counts less by metre the longer the way";
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
    const auto whole = piecesOf(errors, 1), gap = piecesOf(errors, 2);
    ASSERT_EQ(whole.size(), 1u) << "no line leaves the picture";
    ASSERT_EQ(gap.size(), 2u);
    const double middle = whole[0].front().x + 5.45 / 9.9 * (whole[0].back().x - whole[0].front().x);
    EXPECT_LT(gap[0].back().x, middle);
    EXPECT_GT(gap[1].front().x, middle);
    EXPECT_EQ(piecesOf(above, 1).size(), 1u) << "the ground truth";
    EXPECT_EQ(piecesOf(above, 2).size(), 1u);
    EXPECT_EQ(piecesOf(above, 3).size(), 2u);
}

TEST_F(Plots, LongBarsEndAtTheEdgeAndAllLabelsAreBesideIt) {
    for (const char* name : {"a", "b", "slow", "busy"}) add(name, walk());
    sequence_.runs[2].total = {"total", 654, 765.4, 654.3};
    sequence_.runs[3].cpu_ms_per_frame = 321.4;
    std::vector<std::string> stages;
    const std::string svg = stageFigure(results(), stages).svg;
    std::map<double, double> ends;  // by row
    const std::string bars =
        svg.substr(svg.find("gnuplot_plot_1\""), svg.find("gnuplot_plot_2\"") - svg.find("gnuplot_plot_1\""));
    const std::regex corner(R"(([-0-9.]+),([-0-9.]+))");
    for (std::sregex_iterator at(bars.begin(), bars.end(), corner), end; at != end; ++at) {
        const double row = std::stod((*at)[2]);
        ends[row] = std::max(ends[row], std::stod((*at)[1]));
    }
    ASSERT_GE(ends.size(), 8u) << "upper and lower sides of four bars";
    std::vector<double> rights;
    for (const auto& [row, right] : ends) rights.push_back(right);
    const double edge = rights[5];
    EXPECT_EQ(rights[4], edge);
    for (const std::size_t other : {0u, 2u, 6u}) {
        EXPECT_LT(rights[other], 0.85 * edge) << "7 of 9 ms";
        EXPECT_NEAR(rights[other], rights[0], 0.1) << "all 7 ms";
    }
    const std::regex label("translate\\(([0-9.]+),[^<]*<text>(<[^>]*>)*mean");
    std::size_t labels = 0;
    for (std::sregex_iterator at(svg.begin(), svg.end(), label), end; at != end; ++at, ++labels)
        EXPECT_GT(std::stod((*at)[1]), edge);
    EXPECT_EQ(labels, 4u) << svg;
}

}  // namespace
}  // namespace roevo
