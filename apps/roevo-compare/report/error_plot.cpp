#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

constexpr std::size_t kMaxIntervals = 800;  // of a line, each with its largest error
constexpr int kWidth = 960, kHeight = 300;  // px
constexpr char kMargins[] = "unset key\nset lmargin 9\nset rmargin 2\nset tmargin 1\nset bmargin 2.6\n";
constexpr double kMinError = 1e-3;  // cm: what is less is of no interest, and has no logarithm

struct Line {
    std::string name;
    LineStyle style;
    std::vector<double> times, errors;  // s since the sequence's first pose; cm
};

std::vector<std::vector<double>> thinned(const Line& line) {
    const std::size_t step = (line.times.size() + kMaxIntervals - 1) / kMaxIntervals;
    const double gap = largestStep(line.times) * static_cast<double>(step);
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < line.times.size(); i += step) {
        const std::size_t end = std::min(i + step, line.times.size());
        const auto begin = line.errors.begin();
        const auto worst =
            static_cast<std::size_t>(std::max_element(begin + static_cast<std::ptrdiff_t>(i),
                                                      begin + static_cast<std::ptrdiff_t>(end)) -
                                     begin);
        if (!rows.empty() && line.times[worst] - rows.back()[0] > gap) rows.push_back({NAN, NAN});
        rows.push_back({line.times[worst], std::max(line.errors[worst], kMinError)});
    }
    return rows;
}

std::vector<Line> linesOf(const SequenceResults& results, const Legend& legend) {
    const auto& reference = results.sequence->reference;
    std::vector<Line> lines;
    double start = INFINITY;
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        if (!results.evaluated[i].evaluation) continue;
        const Evaluation& evaluation = *results.evaluated[i].evaluation;
        const MethodRun& run = results.sequence->runs[i];
        const std::size_t m = legend.indexOf(run.method);
        Line line{legend.methods[m].label, legend.styles[m], {}, {}};
        for (const PosePair& pair : evaluation.pairs) {
            const StampedPose& pose = run.trajectory[pair.estimate];
            const Eigen::Vector3d centre =
                evaluation.ate.T_reference_estimate * pose.T_world_camera.translation();
            const Eigen::Vector3d truth = reference[pair.reference].T_world_camera.translation();
            line.times.push_back(pose.timestamp);
            line.errors.push_back(100 * (centre - truth).norm());
        }
        start = std::min(start, line.times.front());
        lines.push_back(std::move(line));
    }
    for (Line& line : lines)
        for (double& time : line.times) time -= start;
    std::stable_sort(lines.begin(), lines.end(),
                     [](const Line& a, const Line& b) { return a.style.width < b.style.width; });
    return lines;
}

std::string shownTic(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

// 1, 2, 5 in every decade while these are few: gnuplot would label the powers of ten only.
std::string ticsOf(char axis, double low, double high) {
    const bool few = high / low < 1000;
    std::string tics;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (const double step : {1.0, 2.0, 5.0})
            if (few || step < 1.5) tics += (tics.empty() ? "" : ", ") + shownTic(decade * step);
    return std::string("set ") + axis + "tics (" + tics + ")\n";
}

// What of the errors is shown. Where a line passes through zero it would reach down for ever.
std::pair<double, double> rangeOf(const std::vector<Line>& lines) {
    std::vector<double> all;
    for (const Line& line : lines) all.insert(all.end(), line.errors.begin(), line.errors.end());
    const double low = std::max(percentile(all, 0.01), kMinError);
    return {low, std::max(percentile(all, 1) * 1.3, 10 * low)};
}

std::vector<std::vector<double>> cumulative(const Line& line) {
    std::vector<double> errors = line.errors;
    std::sort(errors.begin(), errors.end());
    std::vector<std::vector<double>> rows;
    for (const std::size_t i : evenly(errors.size(), kMaxIntervals))
        rows.push_back({std::max(errors[i], kMinError),
                        100 * static_cast<double>(i + 1) / static_cast<double>(errors.size())});
    return rows;
}

std::string plotOf(const std::vector<Line>& lines,
                   const std::function<std::vector<std::vector<double>>(const Line&)>& rows) {
    std::string data, plot;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string block = "line" + std::to_string(i);
        data += gnuplotData(block, rows(lines[i]));
        plot += (i == 0 ? "plot " : ", ") + std::string("$") + block + " using 1:2 with lines " +
                gnuplotStyle(lines[i].style);
    }
    return data + plot + "\n";
}

}  // namespace

Figure errorFigure(const SequenceResults& results, const Legend& legend) {
    const std::vector<Line> lines = linesOf(results, legend);
    if (lines.empty()) return {"", "", "No run has errors that could be drawn."};

    double end = 0;
    for (const Line& line : lines) end = std::max(end, line.times.back());
    const auto [low, high] = rangeOf(lines);
    std::string script = std::string(kMargins) +
                         "set logscale y\nset xlabel 'time [s]' offset 0,0.4\n"
                         "set ylabel 'position error [cm]'\nset format y '%g'\nset xrange [0:" +
                         exactNumber(std::max(end, 1e-3)) + "]\nset yrange [" + exactNumber(low) + ":" +
                         exactNumber(high) + "]\n" + ticsOf('y', low, high);
    script += plotOf(lines, thinned);
    return drawFigure(script, kWidth, kHeight, results.sequence->name + ": position error over time", "");
}

Figure cumulativeErrorFigure(const SequenceResults& results, const Legend& legend) {
    const std::vector<Line> lines = linesOf(results, legend);
    if (lines.empty()) return {"", "", "No run has errors that could be drawn."};

    const auto [low, high] = rangeOf(lines);
    std::string script = std::string(kMargins) +
                         "set logscale x\nset xlabel 'position error [cm]' offset 0,0.4\n"
                         "set ylabel 'poses [%]'\nset format x '%g'\nset yrange [0:100]\nset xrange [" +
                         exactNumber(low) + ":" + exactNumber(high) + "]\n" + ticsOf('x', low, high);
    script += plotOf(lines, cumulative);
    return drawFigure(script, kWidth, kHeight, results.sequence->name + ": cumulative position error",
                      "Share of the paired poses whose error is at most so much.");
}

}  // namespace roevo
