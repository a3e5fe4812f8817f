#include "bar_chart.h"

#include <cmath>

#include "programs/gnuplot.h"

namespace roevo {
namespace {

constexpr double kGroupWidth = 0.8;  // of the distance between groups

constexpr int kFirstValueTag = 1000;  // of gnuplot's labels, beyond all others

// px
constexpr int kTitle = 40, kKeyRow = 24, kPanel = 200, kBelow = 80, kLeft = 100, kRight = 15,
              kKeyColumn = 300;

struct Layout {
    int width = 0, height = 0, key_rows = 0;

    explicit Layout(const BarChart& chart) {
        width = plotWidth(chart.groups.size(), kLeft + kRight);
        const int entries =
            static_cast<int>(chart.series.size()) + !chart.dots_label.empty() + !chart.unit_label.empty();
        const int columns = width / kKeyColumn;
        key_rows = (entries + columns - 1) / columns;
        height = head() + static_cast<int>(chart.panels.size()) * (kPanel + kBelow);
    }
    int head() const { return kTitle + key_rows * kKeyRow + 26; }
    /// Share of the height, from below, of what is so many px from above.
    double down(int px) const { return 1 - static_cast<double>(px) / height; }
    double across(int px) const { return static_cast<double>(px) / width; }
};

std::string headScript(const BarChart& chart, const Layout& layout) {
    std::string script =
        format("set multiplot\nset boxwidth %g\nset lmargin at screen %g\nset rmargin at screen %g\n",
               0.9 * kGroupWidth / static_cast<double>(chart.series.size()), layout.across(kLeft),
               layout.across(layout.width - kRight)) +
        "set grid noxtics\nset xtics scale 0 " + plotTics(chart.groups) +
        format("\nset xrange [-0.6:%g]\nset yrange [0:*]\n", static_cast<double>(chart.groups.size()) - 0.4) +
        format("set key at screen 0.5, %g center center vertical maxrows %d Left reverse width -2\n",
               layout.down(kTitle + layout.key_rows * kKeyRow / 2), layout.key_rows) +
        "set label 1 " + gnuplotText(chart.title) +
        format(" at screen 0.5, %g center textcolor rgb '#222222'\n", layout.down(kTitle / 2));
    for (const auto& [x, text] : chart.marks)
        script += "set label " + gnuplotText(text) +
                  format(" at first %g, graph 0.03 rotate by 90 front font ',11'\n", x);
    return script;
}

// The value of each bar over its panel: those of small bars cannot be read off the axis.
std::string valueLabels(const BarChart& chart, const BarChart::Panel& panel) {
    std::string script;
    int tag = kFirstValueTag;
    for (std::size_t g = 0; g < panel.bars.size(); ++g)
        for (std::size_t s = 0; s < panel.bars[g].size(); ++s)
            script += std::isfinite(panel.bars[g][s])
                          ? format("set label %d '%.3g' at first %g, graph 1.05 center font ',9'\n", tag++,
                                   panel.bars[g][s], chart.barAt(g, s))
                          : format("unset label %d\n", tag++);
    return script;
}

std::string panelScript(const BarChart& chart, const Layout& layout, std::size_t number) {
    const BarChart::Panel& panel = chart.panels[number];
    const int top = layout.head() + static_cast<int>(number) * (kPanel + kBelow);
    const std::string block = "bars" + std::to_string(number), dots = "dots" + std::to_string(number);
    std::vector<std::vector<double>> rows, dot_rows;
    for (std::size_t g = 0; g < panel.bars.size(); ++g) {
        rows.push_back({static_cast<double>(g)});
        rows.back().insert(rows.back().end(), panel.bars[g].begin(), panel.bars[g].end());
    }
    for (const auto& [x, y] : panel.dots) dot_rows.push_back({x, y});
    std::string script = gnuplotData(block, rows) + gnuplotData(dots, dot_rows) + valueLabels(chart, panel) +
                         format("set tmargin at screen %g\nset bmargin at screen %g\nset ylabel ",
                                layout.down(top), layout.down(top + kPanel)) +
                         gnuplotText(panel.y_label) + "\nplot ";
    for (std::size_t s = 0; s < chart.series.size(); ++s)
        script += format("%s$%s using ($1%+.3f):%zu with boxes lt %d title ", s > 0 ? ", " : "",
                         block.c_str(), chart.barAt(0, s), s + 2, chart.series[s].colour) +
                  gnuplotText(chart.series[s].label);
    if (!chart.unit_label.empty())
        script += ", 1 with lines lw 1.5 dt 2 lc rgb '#222222' title " + gnuplotText(chart.unit_label);
    if (!chart.dots_label.empty())
        script += ", $" + dots + " using 1:2 with points pt 7 ps 0.35 lc rgb '#222222' title " +
                  gnuplotText(chart.dots_label);
    return script + '\n';
}

}  // namespace

double BarChart::barAt(std::size_t group, std::size_t of_series) const {
    const auto count = static_cast<double>(series.size());
    return static_cast<double>(group) +
           kGroupWidth / count * (static_cast<double>(of_series) - (count - 1) / 2);
}

void addBarChart(StudyReport& report, const std::string& folder, const std::string& name,
                 const BarChart& chart) {
    const Layout layout(chart);
    std::string script = headScript(chart, layout);
    for (std::size_t i = 0; i < chart.panels.size(); ++i)
        script += panelScript(chart, layout, i) + "unset key\nunset label 1\n";
    addPlot(report, folder, name, script + "unset multiplot", layout.width, layout.height);
}

}  // namespace roevo
