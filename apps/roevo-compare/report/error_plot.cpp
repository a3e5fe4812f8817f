#include <algorithm>
#include <array>
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

constexpr std::size_t kMaxIntervals = 800;                          // of a line, each with its largest error
constexpr int kHeight = 300, kAxesHeight = 480, kDriftWidth = 480;  // px
const std::string kMargins = "unset key\nset lmargin 10\nset rmargin 2\nset tmargin 1\nset bmargin 2.6\n";
constexpr double kMinError = 1e-3;  // cm, deg: what is less is of no interest, and has no logarithm
constexpr double kAxesFoot = 0.08, kAxesShare = (1 - kAxesFoot) / 3;  // of the picture with the axes
constexpr double kMinDrift = 1e-3;                                    // %, deg/m
constexpr double kShortestPath = 0.1, kLongestPath = 1e4;  // m: as long as rooms and buildings need
constexpr std::size_t kFewestPieces = 10;                  // of a path length
constexpr double kClipAt = 5;  // times the median extent: a line of more leaves the picture of the axes
const Figure kNothing{"", "", "No run has errors that could be drawn."};

using Rows = std::vector<std::vector<double>>;

struct ErrorLine {
    std::size_t run;
    std::string name;
    LineStyle style;
    std::vector<double> times, errors, angles;  // s since the sequence's first pose; cm; deg
    std::array<std::vector<double>, 3> axes;    // cm, along those of the ground truth's world
};

// The largest value of each interval.
Rows thinned(const std::vector<double>& times, const std::vector<double>& values) {
    const std::size_t step = (times.size() + kMaxIntervals - 1) / kMaxIntervals;
    const double gap = largestStep(times) * static_cast<double>(step);
    Rows rows;
    for (std::size_t i = 0; i < times.size(); i += step) {
        std::size_t worst = i;
        for (std::size_t k = i; k < std::min(i + step, times.size()); ++k)
            if (std::abs(values[k]) > std::abs(values[worst])) worst = k;
        if (!rows.empty() && times[worst] - rows.back()[0] > gap) rows.push_back({NAN, NAN});
        rows.push_back({times[worst], values[worst]});
    }
    return rows;
}

std::vector<ErrorLine> linesOf(const SequenceResults& results, const Legend& legend) {
    const auto& reference = results.sequence->reference;
    std::vector<ErrorLine> lines;
    double start = INFINITY;
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        if (!results.evaluated[i].evaluation) continue;
        const Evaluation& evaluation = *results.evaluated[i].evaluation;
        const MethodRun& run = results.sequence->runs[i];
        const std::size_t m = legend.indexOf(run.method);
        ErrorLine line{i, legend.methods[m].label, legend.styles[m], {}, {}, {}, {}};
        for (const PosePair& pair : evaluation.pairs) {
            const StampedPose& pose = run.trajectory[pair.estimate];
            const Pose estimate = evaluation.ate.T_reference_estimate * pose.T_world_camera;
            const Pose& truth = reference[pair.reference].T_world_camera;
            const Eigen::Vector3d difference = 100 * (estimate.translation() - truth.translation());
            line.times.push_back(pose.timestamp);
            line.errors.push_back(std::max(difference.norm(), kMinError));
            line.angles.push_back(
                std::max(truth.rotation().angularDistance(estimate.rotation()) / kDegree, kMinError));
            for (std::size_t k = 0; k < 3; ++k) line.axes[k].push_back(difference[static_cast<int>(k)]);
        }
        start = std::min(start, line.times.front());
        lines.push_back(std::move(line));
    }
    for (ErrorLine& line : lines)
        for (double& time : line.times) time -= start;
    std::stable_sort(lines.begin(), lines.end(),
                     [](const ErrorLine& a, const ErrorLine& b) { return a.style.width < b.style.width; });
    return lines;
}

std::string shownTic(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

// Nearly all digits within about a decade, so that a logarithmic axis is seen to be one; 1, 2, 5 while these
// are few: gnuplot would label the powers of ten only.
std::string ticsOf(char axis, double low, double high) {
    const double span = high / low;
    std::string tics;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (int digit = 1; digit < 10; ++digit) {
            const bool is_round = digit == 1 || digit == 2 || digit == 5, has_room = digit != 7 && digit != 9;
            if (digit == 1 || (has_room && span < 12) || (is_round && span < 1000))
                tics += (tics.empty() ? "" : ", ") + shownTic(decade * digit);
        }
    return std::string("set ") + axis + "tics (" + tics + ")\n";
}

// The least and the largest error.
std::pair<double, double> extremesOf(const std::vector<ErrorLine>& lines,
                                     std::vector<double> ErrorLine::*values) {
    std::vector<double> all;
    for (const ErrorLine& line : lines) all.insert(all.end(), (line.*values).begin(), (line.*values).end());
    return {percentile(all, 0), percentile(all, 1)};
}

// With some room around them.
std::pair<double, double> roomFor(const std::pair<double, double>& extremes) {
    return {extremes.first / 1.2, std::max(extremes.second * 1.2, 10 * extremes.first)};
}

Rows cumulative(const ErrorLine& line) {
    std::vector<double> errors = line.errors;
    std::sort(errors.begin(), errors.end());
    Rows rows;
    for (const std::size_t i : evenly(errors.size(), kMaxIntervals))
        rows.push_back({errors[i], 100 * static_cast<double>(i + 1) / static_cast<double>(errors.size())});
    return rows;
}

std::string rangeText(double low, double high) {
    return "[" + exactNumber(low) + ":" + exactNumber(high) + "]\n";
}

std::string timeRange(const std::vector<ErrorLine>& lines) {
    double end = 1e-3;
    for (const ErrorLine& line : lines) end = std::max(end, line.times.back());
    return "set xrange " + rangeText(0, end);
}

std::string logarithmic(char axis, std::pair<double, double> range) {
    const std::string name(1, axis);
    return "set logscale " + name + "\nset format " + name + " '%g'\nset " + name + "range " +
           rangeText(range.first, range.second) + ticsOf(axis, range.first, range.second);
}

std::string plotOf(const std::vector<ErrorLine>& lines, const std::function<Rows(const ErrorLine&)>& rows,
                   const std::string& with = "lines ") {
    std::string data, plot;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string block = "line" + std::to_string(i);
        data += gnuplotData(block, rows(lines[i]));
        plot += (i == 0 ? "plot " : ", ") + std::string("$") + block + " using 1:2 with " + with +
                gnuplotStyle(lines[i].style);
    }
    return data + plot + "\n";
}

Figure draw(const std::vector<ErrorLine>& lines, const std::string& script, int width, int height,
            const std::string& name, const std::string& note = {}) {
    Figure figure = drawFigure(script, width, height, name, note);
    for (const ErrorLine& line : lines) figure.lines.emplace_back(line.name, line.style);
    return figure;
}

Figure overTime(const SequenceResults& results, const Legend& legend, std::vector<double> ErrorLine::*values,
                const std::string& what, const std::string& unit, const std::string& note = {}) {
    const std::vector<ErrorLine> lines = linesOf(results, legend);
    if (lines.empty()) return kNothing;
    const auto extremes = extremesOf(lines, values);
    const std::string script =
        kMargins + timeRange(lines) + "set xlabel 'time [s]' offset 0,0.4\nset ylabel '" + what + " [" +
        unit + "]'\n" + logarithmic('y', roomFor(extremes)) +
        plotOf(lines, [&](const ErrorLine& line) { return thinned(line.times, line.*values); });
    return draw(lines, script, kFigureWidth, kHeight, results.sequence->name + ": " + what + " over time",
                withLeast(note, extremes.first, kMinError));
}

// The largest of 1, 2, 5 times a power of ten up to the extent: three to five tics from -extent to extent.
double ticStep(double extent) {
    const double decade = std::pow(10, std::floor(std::log10(extent)));
    return decade * (extent >= 5 * decade ? 5 : extent >= 2 * decade ? 2 : 1);
}

// The largest error along an axis, cm.
double extentOf(const ErrorLine& line) {
    double extent = kMinError;
    for (const auto& axis : line.axes)
        for (const double error : axis) extent = std::max(extent, std::abs(error));
    return extent;
}

// Path lengths of 1, 2 and 5 times a power of ten over which a run has enough pieces, m.
struct Drift {
    Rows translation, rotation;  // length, m; error, % and deg/m
};
Drift driftOf(const SequenceResults& results, std::size_t run) {
    const auto& pairs = results.evaluated[run].evaluation->pairs;
    Drift drift;
    for (double decade = kShortestPath; decade < kLongestPath; decade *= 10)
        for (const double step : {1., 2., 5.}) {
            const RelativeError error = relativePoseErrorOverDistance(
                results.sequence->reference, results.sequence->runs[run].trajectory, pairs, step * decade);
            if (error.translation.count < kFewestPieces) continue;
            drift.translation.push_back({step * decade, std::max(100 * error.translation.mean, kMinDrift)});
            drift.rotation.push_back({step * decade, std::max(error.rotation.mean, kMinDrift)});
        }
    return drift;
}

Figure driftFigure(const std::vector<ErrorLine>& lines, const std::vector<Drift>& drifts, Rows Drift::*rows,
                   const std::string& label, const std::string& name) {
    double low = INFINITY, high = 0, shortest = INFINITY, longest = 0;
    for (const Drift& drift : drifts)
        for (const auto& row : drift.*rows) {
            shortest = std::min(shortest, row[0]), longest = std::max(longest, row[0]);
            low = std::min(low, row[1]), high = std::max(high, row[1]);
        }
    std::size_t i = 0;
    const std::string script =
        kMargins + logarithmic('x', {shortest / 1.1, longest * 1.1}) +
        logarithmic('y', {low / 1.3, high * 1.3}) +
        "set xlabel 'path length [m]' offset 0,0.4\nset ylabel '" + label + "'\n" +
        plotOf(
            lines, [&](const ErrorLine&) { return drifts[i++].*rows; }, "linespoints pt 7 ps 0.4 ");
    return draw(lines, script, kDriftWidth, kHeight, name, withLeast("", low, kMinDrift));
}

}  // namespace

Figure errorFigure(const SequenceResults& results, const Legend& legend) {
    return overTime(results, legend, &ErrorLine::errors, "position error", "cm");
}

Figure angularErrorFigure(const SequenceResults& results, const Legend& legend) {
    return overTime(
        results, legend, &ErrorLine::angles, "angular error", "deg",
        "Angle between the estimated and the true orientation. A constant part means little, for the "
        "alignment fits positions only; look at the changes.");
}

Figure axisErrorFigure(const SequenceResults& results, const Legend& legend) {
    const std::vector<ErrorLine> lines = linesOf(results, legend);
    if (lines.empty()) return kNothing;
    std::vector<double> extents;
    for (const ErrorLine& line : lines) extents.push_back(extentOf(line));
    double extent = 0;  // of all but those that would squash the others
    for (const double each : extents)
        if (each <= kClipAt * percentile(extents, 0.5)) extent = std::max(extent, 1.1 * each);
    std::string script = kMargins + timeRange(lines) + "set yrange " + rangeText(-extent, extent) +
                         "set ytics " + exactNumber(ticStep(extent)) +
                         "\nset xzeroaxis lc rgb '#666666'\nset bmargin 0.4\nset multiplot\n";
    std::string leaving;
    for (std::size_t k = 0; k < 3; ++k) {
        // The axis of time is written once, in the room of the lowest picture
        script += "set origin 0," + exactNumber(kAxesFoot + (2 - static_cast<double>(k)) * kAxesShare) +
                  "\nset size 1," + exactNumber(kAxesShare) + "\nset format x ''\n";
        if (k == 2)
            script += "set origin 0,0\nset size 1," + exactNumber(kAxesFoot + kAxesShare) +
                      "\nset bmargin 2.6\nset format x '%g'\nset xlabel 'time [s]' offset 0,0.4\n";
        script += std::string("set ylabel '") + "xyz"[k] + " [cm]'\n" +
                  plotOf(lines, [&](const ErrorLine& line) { return thinned(line.times, line.axes[k]); });
    }
    for (const ErrorLine& line : lines)
        if (extentOf(line) > extent) leaving += (leaving.empty() ? "" : ", ") + line.name;
    return draw(lines, script + "unset multiplot\n", kFigureWidth, kAxesHeight,
                results.sequence->name + ": position error along the axes over time",
                "Estimate minus ground truth along the axes of the ground truth’s world." +
                    (leaving.empty() ? "" : " Leaving the picture: " + leaving));
}

Figure cumulativeErrorFigure(const SequenceResults& results, const Legend& legend) {
    const std::vector<ErrorLine> lines = linesOf(results, legend);
    if (lines.empty()) return kNothing;
    const auto extremes = extremesOf(lines, &ErrorLine::errors);
    const std::string script = kMargins + logarithmic('x', roomFor(extremes)) +
                               "set xlabel 'position error [cm]' offset 0,0.4\nset ylabel 'poses [%]'\n"
                               "set yrange [0:100]\n" +
                               plotOf(lines, cumulative);
    return draw(
        lines, script, kFigureWidth, kHeight, results.sequence->name + ": cumulative position error",
        withLeast("Share of the paired poses whose error is at most so much.", extremes.first, kMinError));
}

std::vector<Figure> relativeErrorFigures(const SequenceResults& results, const Legend& legend) {
    std::vector<ErrorLine> lines;
    std::vector<Drift> drifts;
    for (ErrorLine& line : linesOf(results, legend)) {
        Drift drift = driftOf(results, line.run);
        if (drift.translation.empty()) continue;
        lines.push_back(std::move(line));
        drifts.push_back(std::move(drift));
    }
    if (lines.empty()) return {};
    const std::string name = results.sequence->name + ": relative error over path length, ";
    return {driftFigure(lines, drifts, &Drift::translation, "translation [%]", name + "translation"),
            driftFigure(lines, drifts, &Drift::rotation, "rotation [deg/m]", name + "rotation")};
}

}  // namespace roevo
