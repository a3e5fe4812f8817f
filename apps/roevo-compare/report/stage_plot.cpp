#include <algorithm>
#include <cmath>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

constexpr int kBarHeight = 30, kBesideBars = 56;  // px
constexpr std::size_t kLongestLabel = 42;         // characters
constexpr double kMarginByCharacter = 0.95;       // gnuplot counts in widths of a wide one
constexpr char kBeyond[] = " ▶";
constexpr double kClipBarAt =
    5;  // times the median bar: what is longer is cut off, so that others stay legible
constexpr double kMarksAt = 2;       // times the longest bar: marks that lie further out are cut off, too
constexpr double kLeastRest = 0.02;  // share of the total that is worth a piece of the bar

struct Bar {
    std::string label;
    std::vector<std::pair<std::size_t, double>> pieces;  // stage and mean time, ms
    StageStatistics total;
    double processor = 0;
};

std::size_t indexOf(std::vector<std::string>& stages, const std::string& name) {
    const auto at = std::find(stages.begin(), stages.end(), name);
    if (at != stages.end()) return static_cast<std::size_t>(at - stages.begin());
    stages.push_back(name);
    return stages.size() - 1;
}

bool isTime(double ms) {
    return std::isfinite(ms) && ms > 0;
}

std::vector<Bar> barsOf(const SequenceComparison& sequence, std::vector<std::string>& stages) {
    std::vector<Bar> bars;
    for (const MethodRun& run : sequence.runs) {
        if (!run.ok() || !isTime(run.total.mean)) continue;
        Bar bar{shortened(cleanText(labelOf(run)), kLongestLabel), {}, run.total, run.cpu_ms_per_frame};
        double sum = 0;
        for (const StageStatistics& stage : run.stages)
            if (isTime(stage.mean)) {
                bar.pieces.emplace_back(indexOf(stages, stage.name), stage.mean);
                sum += stage.mean;
            }
        // What belongs to no stage, or all of it where a method has none
        if (run.total.mean - sum > kLeastRest * run.total.mean)
            bar.pieces.emplace_back(kNoStage, run.total.mean - sum);
        bars.push_back(std::move(bar));
    }
    return bars;
}

std::string timeText(double ms) {
    return shownNumber(ms, ms < 10 ? 2 : 1);
}

// What a bar's label says: every figure where one of them lies beyond the right edge.
std::string labelOf(const Bar& bar, double end) {
    const auto isBeyond = [&](double ms) { return isTime(ms) && ms > end; };
    const auto text = [&](double ms) { return timeText(ms) + (isBeyond(ms) ? kBeyond : ""); };
    const std::string mean = "mean " + text(bar.total.mean);
    if (!isBeyond(bar.total.mean) && !isBeyond(bar.total.p95) && !isBeyond(bar.processor))
        return mean + " ms";
    return mean + (isTime(bar.total.p95) ? ", 95 % " + text(bar.total.p95) : "") +
           (isTime(bar.processor) ? ", processor " + text(bar.processor) : "");
}

// Right edge of the picture: all bars and marks, but for what is so far out that it would squash the others.
double rightEdge(const std::vector<Bar>& bars) {
    std::vector<double> totals;
    for (const Bar& bar : bars) totals.push_back(bar.total.mean);
    double longest = percentile(totals, 0);
    const auto include = [&](double ms, double limit) {
        if (isTime(ms) && ms <= limit) longest = std::max(longest, ms);
    };
    for (const double total : totals) include(total, kClipBarAt * percentile(totals, 0.5));
    const double limit = kMarksAt * longest;
    for (const Bar& bar : bars)
        for (const double ms : {bar.total.p95, bar.processor}) include(ms, limit);
    return 1.03 * longest;
}

// For the longest of the texts, in gnuplot's characters.
std::string margin(const std::vector<std::string>& texts) {
    std::size_t longest = 0;
    for (const std::string& text : texts) longest = std::max(longest, countCharacters(text));
    return exactNumber(kMarginByCharacter * static_cast<double>(longest) + 2);
}

std::string axes(const std::vector<Bar>& bars, double end) {
    std::string tics, means;
    std::vector<std::string> left, right;
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const std::string row = std::to_string(i);
        left.push_back(bars[i].label);
        right.push_back(labelOf(bars[i], end));
        tics += (i == 0 ? "" : ", ") + gnuplotText(left.back()) + " " + row;
        means += "set label " + gnuplotText(right.back()) + " at graph 1, first " + row +
                 " left offset 0.7,0 textcolor rgb '#222222'\n";
    }
    return means + "unset key\nset lmargin " + margin(left) + "\nset rmargin " + margin(right) +
           "\nset tmargin 0.5\nset bmargin 2.6\nset border 1\n"
           "set xlabel 'time per frame [ms]' offset 0,0.4\nset grid noytics xtics\nset ytics scale 0\n"
           "set xrange [0:" +
           exactNumber(end) + "]\nset yrange [" + exactNumber(static_cast<double>(bars.size()) - 0.35) +
           ":-0.6]\nset ytics (" + tics + ")\n";
}

std::string plotScript(const std::vector<Bar>& bars, double end) {
    std::vector<std::vector<double>> rectangles, ticks, processor;
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const Bar& bar = bars[i];
        const double y = static_cast<double>(i);
        double x = 0;
        for (const auto& [stage, ms] : bar.pieces) {
            if (x < end)
                rectangles.push_back(
                    {x, y, x, std::min(x + ms, end), y - 0.3, y + 0.3, static_cast<double>(stageRgb(stage))});
            x += ms;
        }
        if (isTime(bar.total.p95) && bar.total.p95 <= end)
            ticks.push_back({bar.total.p95, y - 0.38, 0, 0.76});
        if (isTime(bar.processor) && bar.processor <= end) processor.push_back({bar.processor, y});
    }
    std::string data = gnuplotData("bars", rectangles);
    std::string plot = "plot $bars using 1:2:3:4:5:6:7 with boxxyerror fc rgb variable fs solid 1 noborder";
    if (!ticks.empty()) {
        data += gnuplotData("ticks", ticks);
        plot += ", $ticks using 1:2:3:4 with vectors nohead lc rgb '#222222' lw 1.6 dt 1";
    }
    if (!processor.empty()) {
        data += gnuplotData("processor", processor);
        plot += ", $processor using 1:2 with points pt 13 ps 0.9 lc rgb '#222222'";
    }
    return data + plot + "\n";
}

std::vector<std::pair<std::string, unsigned>> fillsOf(const std::vector<Bar>& bars,
                                                      const std::vector<std::string>& stages) {
    std::vector<std::pair<std::string, unsigned>> fills;
    const auto used = [&](std::size_t stage) {
        return std::any_of(bars.begin(), bars.end(), [&](const Bar& bar) {
            return std::any_of(bar.pieces.begin(), bar.pieces.end(),
                               [&](const auto& piece) { return piece.first == stage; });
        });
    };
    for (std::size_t k = 0; k < stages.size(); ++k)
        if (used(k)) fills.emplace_back(stages[k], stageRgb(k));
    if (used(kNoStage)) fills.emplace_back("in no stage", stageRgb(kNoStage));
    return fills;
}

}  // namespace

Figure stageFigure(const SequenceResults& results, std::vector<std::string>& stages) {
    const std::vector<Bar> bars = barsOf(*results.sequence, stages);
    if (bars.empty()) return {"", "", "No run has times that could be drawn."};
    const double end = rightEdge(bars);
    const bool beyond = std::any_of(bars.begin(), bars.end(), [&](const Bar& bar) {
        return labelOf(bar, end).find(kBeyond) != std::string::npos;
    });
    const int height = kBarHeight * static_cast<int>(bars.size()) + kBesideBars;
    Figure figure = drawFigure(axes(bars, end) + plotScript(bars, end), kFigureWidth, height,
                               results.sequence->name + ": time per frame by stage",
                               !beyond ? ""
                                       : "A bar whose mean has a ▶ goes on beyond the right edge, as do the "
                                         "marks of other figures with one.");
    figure.fills = fillsOf(bars, stages);
    if (!figure.fills.empty())
        figure.lines = {{"| 95th percentile", {"none", 0, ""}},
                        {"◆ processor time, all threads", {"none", 0, ""}}};
    return figure;
}

}  // namespace roevo
