#include <algorithm>
#include <cmath>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/distributions.h"
#include "roevo-compare/report/plots.h"

namespace roevo {
namespace {

constexpr int kCurveHeight = 340, kBoxHeight = 70, kBoxHead = 70;  // px
constexpr double kLeastValue = 1e-4;  // of any unit: what is less has no logarithm worth showing

// By method: figures in ascending order, and how many runs there are.
struct Sample {
    std::vector<double> values;
    std::size_t runs = 0;
};

std::vector<Sample> samplesOf(const Metric& metric, const std::vector<SequenceResults>& results,
                              const Legend& legend) {
    std::vector<Sample> samples(legend.methods.size());
    for (const SequenceResults& result : results)
        for (std::size_t i = 0; i < result.evaluated.size(); ++i) {
            Sample& sample = samples[legend.indexOf(result.sequence->runs[i].method)];
            if (!result.sequence->runs[i].skipped.empty()) continue;
            ++sample.runs;
            if (const auto value = metricOf(metric, result, i))
                sample.values.push_back(std::max(*value, kLeastValue));
        }
    for (Sample& sample : samples) std::sort(sample.values.begin(), sample.values.end());
    return samples;
}

double lowestOf(const std::vector<Sample>& samples) {
    double low = HUGE_VAL;
    for (const Sample& sample : samples)
        if (!sample.values.empty()) low = std::min(low, sample.values.front());
    return low;
}

// The range of all, on a logarithmic axis whose figures stand at 1, 2 and 5 where there is room.
std::string axis(const Metric& metric, const std::vector<Sample>& samples) {
    double low = lowestOf(samples) / 1.15, high = 0;
    for (const Sample& sample : samples)
        if (!sample.values.empty()) high = std::max(high, 1.15 * sample.values.back());
    std::string tics;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (const double step : {1.0, 2.0, 5.0})
            if (high / low < 1000 || step < 1.5)
                tics += (tics.empty() ? "" : ", ") + plainNumber(decade * step);
    return "unset key\nset logscale x\nset xrange [" + exactNumber(low) + ":" + exactNumber(high) +
           "]\nset xtics (" + tics + ")\nset xlabel " + gnuplotText(metric.title + " [" + metric.unit + "]") +
           " offset 0,0.4\nset rmargin 3\n";
}

bool allEmpty(const std::vector<Sample>& samples) {
    return std::all_of(samples.begin(), samples.end(), [](const Sample& s) { return s.values.empty(); });
}

}  // namespace

Figure boxFigure(const Metric& metric, const std::vector<SequenceResults>& results, const Legend& legend) {
    const auto samples = samplesOf(metric, results, legend);
    if (allEmpty(samples)) return {"", "", "No run has this error."};
    const auto count = static_cast<int>(samples.size());
    std::string script = axis(metric, samples), plot;
    script += "set yrange [" + std::to_string(count) + ".5:0.5]\nset lmargin 26\nset bmargin 3\nset ytics (";
    for (int m = 0; m < count; ++m)
        script += (m ? ", " : "") +
                  gnuplotText(shortened(legend.methods[static_cast<std::size_t>(m)].label, 28)) + " " +
                  std::to_string(m + 1);
    script += ")\n";
    int object = 1;
    for (int m = 0; m < count; ++m) {
        const auto& values = samples[static_cast<std::size_t>(m)].values;
        if (values.empty()) continue;
        const LineStyle& style = legend.styles[static_cast<std::size_t>(m)];
        const auto at = [&](double share) { return exactNumber(percentile(values, share)); };
        const std::string y = std::to_string(m + 1), low = at(0.05), high = at(0.95);
        const std::string colour = " lc rgb '" + style.colour + "' lw 2";
        script += "set object " + std::to_string(object++) + " rectangle from " + at(0.25) + "," +
                  exactNumber(m + 0.72) + " to " + at(0.75) + "," + exactNumber(m + 1.28) +
                  " front fs transparent solid 0.25 border lc rgb '" + style.colour + "' fc rgb '" +
                  style.colour + "'\n";
        const auto line = [&](const std::string& x0, double y0, const std::string& x1, double y1) {
            script += "set arrow from " + x0 + "," + exactNumber(y0) + " to " + x1 + "," + exactNumber(y1) +
                      " nohead front" + colour + "\n";
        };
        line(low, m + 1, at(0.25), m + 1);
        line(at(0.75), m + 1, high, m + 1);
        line(at(0.5), m + 0.72, at(0.5), m + 1.28);
        for (const std::string& end : {low, high}) line(end, m + 0.88, end, m + 1.12);
        std::vector<std::vector<double>> beyond;
        for (const double value : values)
            if (value < percentile(values, 0.05) || value > percentile(values, 0.95))
                beyond.push_back({value, static_cast<double>(m + 1)});
        if (beyond.empty()) beyond.push_back({NAN, NAN});
        const std::string block = "beyond" + y;
        script += gnuplotData(block, beyond);
        plot += (plot.empty() ? "plot $" : ", $") + block + " using 1:2 with points pt 6 ps 0.6 lc rgb '" +
                style.colour + "'";
    }
    return drawFigure(script + plot + "\n", kFigureWidth, kBoxHead + kBoxHeight * count,
                      metric.title + ", a box for each method",
                      withLeast("Box: half of the recordings; whiskers: 5 and 95 %; points: those beyond.",
                                lowestOf(samples), kLeastValue));
}

Figure cumulativeFigure(const Metric& metric, const std::vector<SequenceResults>& results,
                        const Legend& legend) {
    const auto samples = samplesOf(metric, results, legend);
    if (allEmpty(samples)) return {"", "", "No run has this error."};
    std::string script = axis(metric, samples) +
                         "set yrange [0:100]\nset ylabel 'recordings [%]'\nset lmargin 9\nset bmargin 3\n";
    std::string plot;
    std::vector<std::pair<std::string, LineStyle>> lines;
    for (std::size_t m = 0; m < samples.size(); ++m) {
        const Sample& sample = samples[m];
        std::vector<std::vector<double>> rows;
        for (std::size_t i = 0; i < sample.values.size(); ++i)
            rows.push_back(
                {sample.values[i], 100.0 * static_cast<double>(i + 1) / static_cast<double>(sample.runs)});
        if (rows.empty()) continue;
        const std::string block = "curve" + std::to_string(m);
        script += gnuplotData(block, rows);
        plot += (plot.empty() ? "plot $" : ", $") + block + " using 1:2 with steps " +
                gnuplotStyle(legend.styles[m]);
        lines.emplace_back(legend.methods[m].label, legend.styles[m]);
    }
    Figure figure = drawFigure(
        script + plot + "\n", kFigureWidth, kCurveHeight, metric.title + ", cumulative",
        withLeast(
            "Share of the recordings whose error is at most so much. One without a result never gets there.",
            lowestOf(samples), kLeastValue));
    figure.lines = lines;
    return figure;
}

}  // namespace roevo
