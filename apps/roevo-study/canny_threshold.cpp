// Error of the trajectory under different Canny thresholds, relative to that at Otsu's (the paper's Fig.
// "Trajectory errors under different Canny thresholds"; there Otsu's of the magnitudes, here of their roots).
#include <algorithm>
#include <cmath>
#include <limits>

#include "programs/gnuplot.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "study.h"

namespace roevo {
namespace {

constexpr double kFactors[] = {0.5, 0.7, 1, 1.5, 2, 2.8, 4, 5.6, 8};  // of otsuThreshold()
constexpr double kReference = 1;
constexpr double kLowRatio = 0.5;  // of the low threshold to the high one, as in the paper
constexpr double kNoFloor = 1;     // Sobel units: the factor alone is to decide

struct ThresholdErrors {
    std::optional<double> ate, rpe_translation, rpe_rotation;  // m, m/s, deg/s
};

struct ThresholdRow {
    double factor = 0;
    StudyRun run;
    ThresholdErrors errors;
};

ThresholdErrors errorsOf(const StudyRun& run) {
    ThresholdErrors errors;
    if (!run.evaluation) return errors;
    errors.ate = run.evaluation->ate.translation.rmse;
    if (run.evaluation->rpe_second.translation.count > 0) {
        errors.rpe_translation = run.evaluation->rpe_second.translation.rmse;
        errors.rpe_rotation = run.evaluation->rpe_second.rotation.rmse;
    }
    return errors;
}

std::optional<double> ratio(std::optional<double> value, std::optional<double> reference) {
    if (!value || !reference || !(*reference > 0)) return std::nullopt;
    return *value / *reference;
}

std::vector<double> factorsWith(double configured) {
    std::vector<double> factors(std::begin(kFactors), std::end(kFactors));
    if (std::find(factors.begin(), factors.end(), configured) == factors.end()) factors.push_back(configured);
    std::sort(factors.begin(), factors.end());
    return factors;
}

const ThresholdRow& atOtsu(const std::vector<ThresholdRow>& rows) {
    return *std::find_if(rows.begin(), rows.end(),
                         [](const ThresholdRow& row) { return row.factor == kReference; });
}

// Over the recordings, of the ratio to the error at Otsu; a run that failed has an infinite error.
double medianRatio(const std::vector<std::vector<ThresholdRow>>& rows, std::size_t factor,
                   std::optional<double> ThresholdErrors::*member) {
    std::vector<double> values;
    for (const std::vector<ThresholdRow>& of_input : rows)
        values.push_back(ratio(of_input[factor].errors.*member, atOtsu(of_input).errors.*member)
                             .value_or(std::numeric_limits<double>::infinity()));
    return median(values).value_or(std::numeric_limits<double>::infinity());
}

ThresholdRow trackAt(const StudyInput& input, double factor) {
    OdometryOptions options = input.options;
    options.edges.canny_factor = factor;
    options.edges.canny_low_ratio = kLowRatio;
    options.edges.min_high_threshold = kNoFloor;
    options.mapping.semi_dense_points = 0;  // costs time and moves no pose
    ThresholdRow row;
    row.factor = factor;
    row.run = trackRecording(input, options);
    row.errors = errorsOf(row.run);
    return row;
}

void addRows(CsvTable& table, const StudyInput& input, double configured,
             const std::vector<ThresholdRow>& rows) {
    const ThresholdErrors reference = atOtsu(rows).errors;
    for (const ThresholdRow& row : rows)
        table.add({input.name, toString(input.options.mode), CsvTable::number(row.factor),
                   row.factor == configured ? "yes" : "no", CsvTable::number(row.errors.ate),
                   CsvTable::number(ratio(row.errors.ate, reference.ate)),
                   CsvTable::number(row.errors.rpe_translation),
                   CsvTable::number(ratio(row.errors.rpe_translation, reference.rpe_translation)),
                   CsvTable::number(row.errors.rpe_rotation),
                   CsvTable::number(ratio(row.errors.rpe_rotation, reference.rpe_rotation)),
                   CsvTable::number(row.run.points), std::to_string(row.run.frames),
                   std::to_string(row.run.tracked), row.run.fault});
}

constexpr double kTop = 8;  // ratios beyond leave the plot: the odometry has lost its way

struct Panel {
    std::string block, title, y_label;
    std::optional<double> ThresholdErrors::*member;
    double left = 0, right = 0;  // of the axes, shares of the width
};

// One thin line for each recording, a thick one for their median.
std::string draw(const Panel& panel, const std::vector<double>& factors, double configured,
                 const std::vector<std::string>& names, const std::vector<std::vector<ThresholdRow>>& rows) {
    double low = 0.8, high = 1.25;
    std::vector<std::vector<double>> lines;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        std::vector<double> line{factors[f], medianRatio(rows, f, panel.member)};
        for (const std::vector<ThresholdRow>& of_input : rows) {
            const auto value = ratio(of_input[f].errors.*panel.member, atOtsu(of_input).errors.*panel.member);
            line.push_back(value.value_or(kMissing));
            if (!value) continue;
            low = std::min(low, *value);
            high = std::max(high, *value);
        }
        lines.push_back(std::move(line));
    }
    std::string script =
        gnuplotData(panel.block, lines) + "set title " + gnuplotText(panel.title) + "\nset ylabel " +
        gnuplotText(panel.y_label) +
        format("\nset yrange [%g:%g]\nset lmargin at screen %g\nset rmargin at screen %g\nplot ", low / 1.2,
               std::min(kTop, high * 1.2), panel.left, panel.right);
    for (std::size_t i = 0; i < names.size(); ++i)
        script += format("$%s using 1:%zu with linespoints lt %zu lw 1.5 ps 0.6 title ", panel.block.c_str(),
                         i + 3, i % 8 + 1) +
                  gnuplotText(names[i]) + ", ";
    return script + "$" + panel.block +
           " using 1:2 with lines lw 4 lc rgb '#222222' title 'median of the recordings', 1/0 with "
           "lines lw 1.5 dt 2 lc rgb '#888888' title " +
           gnuplotText(format("configured: %g x Otsu", configured)) + "\nunset key\n";
}

void plot(StudyReport& report, const std::string& folder, const std::vector<double>& factors,
          double configured, const std::vector<std::string>& names,
          const std::vector<std::vector<ThresholdRow>>& rows) {
    const std::string script =
        "set logscale xy\nset xrange [0.45:9]\nset xtics (0.5, 0.7, 1, 1.5, 2, 2.8, 4, 5.6, 8)\n"
        "set ytics (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10, 20, 50, 100)\n"
        "set xlabel 'high threshold / Otsu threshold'\nset tmargin at screen 0.9\nset bmargin at screen "
        "0.15\n"
        "set key at screen 0.75, 0.85 left top Left reverse\n" +
        format("set arrow from %g, graph 0 to %g, graph 1 nohead lw 1.5 dt 2 lc rgb '#888888'\n", configured,
               configured) +
        "set multiplot\n" +
        draw({"ate", "Absolute trajectory error", "ATE / ATE at Otsu", &ThresholdErrors::ate, 0.065, 0.365},
             factors, configured, names, rows) +
        draw({"rpe", "Relative pose error over 1 s, translation", "RPE / RPE at Otsu",
              &ThresholdErrors::rpe_translation, 0.43, 0.735},
             factors, configured, names, rows) +
        "unset multiplot";
    addPlot(report, folder, "canny.svg", script, 1340, 460);
}

}  // namespace

StudyReport studyCannyThreshold(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    const double configured = inputs.front().options.edges.canny_factor;
    const std::vector<double> factors = factorsWith(configured);
    CsvTable table({"recording", "mode", "factor", "configured", "ate_m", "ate_ratio",
                    "rpe_translation_m_per_s", "rpe_translation_ratio", "rpe_rotation_deg_per_s",
                    "rpe_rotation_ratio", "points_per_frame", "frames", "tracked", "note"});
    std::vector<std::vector<ThresholdRow>> plotted;
    std::vector<std::string> names;
    Progress progress("canny", inputs.size() * factors.size());
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        std::vector<ThresholdRow> rows;
        for (const double factor : factors) {
            rows.push_back(trackAt(input, factor));
            progress.update(++done);
        }
        addRows(table, input, configured, rows);
        if (atOtsu(rows).errors.ate) {
            names.push_back(input.name);
            plotted.push_back(std::move(rows));
        } else {
            report.notes.push_back(input.name +
                                   ": errors at Otsu's threshold are not known: " + atOtsu(rows).run.fault);
        }
    });
    progress.finish();
    addTable(report, folder, "canny.csv", table);
    report.notes.push_back(
        format("The low threshold is half the high one; min_high_threshold is out of force, so that the "
               "factor alone decides. Configured: %g x Otsu. Lines that leave the plot at the top, or end: "
               "the odometry "
               "lost its way.",
               configured));
    if (plotted.empty()) {
        report.summary = "no recording with ground truth: no errors, no plot";
        return report;
    }
    plot(report, folder, factors, configured, names, plotted);

    std::size_t best = 0, at_configured = 0;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        if (medianRatio(plotted, f, &ThresholdErrors::ate) <
            medianRatio(plotted, best, &ThresholdErrors::ate))
            best = f;
        if (factors[f] == configured) at_configured = f;
    }
    const auto described = [&](std::size_t f) {
        const double middle = medianRatio(plotted, f, &ThresholdErrors::ate);
        return format("%g x Otsu (", factors[f]) +
               (std::isfinite(middle) ? format("%.2f)", middle) : "most runs failed)");
    };
    report.summary = counted(plotted.size(), "recording") + ", median of ATE / ATE at Otsu: least at " +
                     described(best) + "; configured: " + described(at_configured);
    return report;
}

}  // namespace roevo
