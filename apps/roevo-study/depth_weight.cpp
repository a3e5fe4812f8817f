// The depth weight of Eq. (20): its curves under the paper's parameters and what each does to the
// trajectory's error.
#include <cmath>
#include <limits>

#include "bar_chart.h"
#include "programs/gnuplot.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "study.h"
#include "tracking/edge_points.h"

namespace roevo {
namespace {

struct WeightSet {
    std::string name;
    double k = 0, min_depth = 0, max_depth = 0;  // 1/m, m, m
};

// The paper's parameters (paragraph of Eq. (20)), those in force, and none: with k = 0 all weigh the same.
std::vector<WeightSet> weightSets(const SensorOptions& sensor) {
    return {{"none", 0, sensor.min_depth, sensor.max_depth},
            {"configured", sensor.depth_weight_k, sensor.min_depth, sensor.max_depth},
            {"TUM RGB-D", 0.75, 0.2, 4.5},
            {"ICL-NUIM", 0.5, 0.1, 6},
            {"ETH3D", 0.5, 0.15, 5}};
}

std::string label(const WeightSet& set) {
    if (set.k == 0) return "none (k = 0)";
    return set.name + format(" (%g, %g, %g)", set.k, set.min_depth, set.max_depth);
}

OdometryOptions with(OdometryOptions options, const WeightSet& set) {
    options.sensor.depth_weight_k = set.k;
    options.sensor.min_depth = set.min_depth;
    options.sensor.max_depth = set.max_depth;
    options.mapping.semi_dense_points = 0;  // costs time and moves no pose
    return options;
}

void drawCurves(StudyReport& report, const std::string& folder, const std::vector<WeightSet>& sets) {
    constexpr double kFarthest = 8, kStep = 0.1;  // m
    std::vector<std::string> head{"depth_m"};
    for (const WeightSet& set : sets) head.push_back(set.name);
    CsvTable table(head);
    std::vector<std::vector<double>> rows;
    for (int i = 0; i <= static_cast<int>(std::lround(kFarthest / kStep)); ++i) {
        const double depth = i * kStep;
        std::vector<double> row{depth};
        std::vector<std::string> fields{CsvTable::number(depth)};
        for (const WeightSet& set : sets) {
            row.push_back(depthWeight(depth, with(OdometryOptions(), set).sensor));
            fields.push_back(CsvTable::number(row.back()));
        }
        rows.push_back(row);
        table.add(fields);
    }
    addTable(report, folder, "depth_weight_curves.csv", table);
    std::string script =
        gnuplotData("curves", rows) +
        "set title 'Weight of an edge point by its depth, Eq. (20)'\n"
        "set xlabel 'depth d (m)'\nset ylabel 'w_s(d)'\nset xrange [0:8]\nset yrange [0:1]\n"
        "set key outside right center Left reverse title 'k (1/m), d_{min} (m), d_{max} (m)'\nplot ";
    for (std::size_t i = 0; i < sets.size(); ++i)
        script += format("%s$curves using 1:%zu with lines lt %zu lw 2.5 %s title ", i > 0 ? ", " : "", i + 2,
                         i == 0 ? std::size_t{7} : i, i == 0 ? "dt 2" : "dt 1") +
                  gnuplotText(label(sets[i]));
    addPlot(report, folder, "depth_weight_curves.svg", script, 860, 400);
}

/// The errors on one recording under every set of weights.
struct WeightErrors {
    std::vector<StudyRun> runs;  // in the order of the sets

    std::optional<double> ate(std::size_t set) const {  // m
        if (!runs[set].evaluation) return std::nullopt;
        return runs[set].evaluation->ate.translation.rmse;
    }
    /// To the error without weight, which is the first.
    std::optional<double> ratio(std::size_t set) const {
        if (!ate(set) || !ate(0) || !(*ate(0) > 0)) return std::nullopt;
        return *ate(set) / *ate(0);
    }
};

void addRows(CsvTable& table, const StudyInput& input, const std::vector<WeightSet>& sets,
             const WeightErrors& errors) {
    for (std::size_t s = 0; s < sets.size(); ++s) {
        const StudyRun& run = errors.runs[s];
        std::optional<double> rpe_translation, rpe_rotation;
        if (run.evaluation && run.evaluation->rpe_second.translation.count > 0) {
            rpe_translation = run.evaluation->rpe_second.translation.rmse;
            rpe_rotation = run.evaluation->rpe_second.rotation.rmse;
        }
        table.add({input.name, toString(input.options.mode), sets[s].name, CsvTable::number(sets[s].k),
                   CsvTable::number(sets[s].min_depth), CsvTable::number(sets[s].max_depth),
                   CsvTable::number(errors.ate(s)), CsvTable::number(errors.ratio(s)),
                   CsvTable::number(rpe_translation), CsvTable::number(rpe_rotation),
                   std::to_string(run.frames), std::to_string(run.tracked), run.fault});
    }
}

void drawErrors(StudyReport& report, const std::string& folder, const std::vector<WeightSet>& sets,
                const std::vector<std::string>& names, const std::vector<WeightErrors>& errors) {
    BarChart chart;
    chart.title = "Error of the trajectory under the depth weight; in brackets k (1/m), d_min (m), d_max (m)";
    chart.unit_label = label(sets[0]);
    chart.groups = names;
    chart.panels = {{"ATE / ATE without weight", {}}};
    for (std::size_t s = 1; s < sets.size(); ++s)
        chart.series.push_back({label(sets[s]), static_cast<int>(s)});
    for (const WeightErrors& of_input : errors) {
        chart.panels[0].bars.emplace_back();
        for (std::size_t s = 1; s < sets.size(); ++s)
            chart.panels[0].bars.back().push_back(of_input.ratio(s).value_or(kMissing));
    }
    addBarChart(report, folder, "depth_weight.svg", chart);
}

}  // namespace

StudyReport studyDepthWeight(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    const std::vector<WeightSet> sets = weightSets(inputs.front().options.sensor);
    drawCurves(report, folder, sets);

    CsvTable table({"recording", "mode", "weight", "k", "d_min_m", "d_max_m", "ate_m", "ate_ratio",
                    "rpe_translation_m_per_s", "rpe_rotation_deg_per_s", "frames", "tracked", "note"});
    std::vector<WeightErrors> measured;
    std::vector<std::string> names;
    Progress progress("depth-weight", inputs.size() * sets.size());
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        WeightErrors errors;
        for (const WeightSet& set : sets) {
            errors.runs.push_back(trackRecording(input, with(input.options, set)));
            progress.update(++done);
        }
        addRows(table, input, sets, errors);
        if (errors.ate(0)) {
            names.push_back(input.name);
            measured.push_back(std::move(errors));
        } else {
            report.notes.push_back(input.name + ": errors are not known: " + errors.runs[0].fault);
        }
    });
    progress.finish();
    addTable(report, folder, "depth_weight.csv", table);
    if (measured.empty()) {
        report.summary = "no recording with ground truth: curves only";
        return report;
    }
    drawErrors(report, folder, sets, names, measured);

    report.summary = counted(names.size(), "recording") + ", ATE relative to no weight (median):";
    for (std::size_t s = 1; s < sets.size(); ++s) {
        std::vector<double> ratios;
        for (const WeightErrors& errors : measured)  // a run that failed has an infinite error
            ratios.push_back(errors.ratio(s).value_or(std::numeric_limits<double>::infinity()));
        const double middle = median(ratios).value_or(std::numeric_limits<double>::infinity());
        report.summary += format("%s %s ", s > 1 ? "," : "", sets[s].name.c_str()) +
                          (std::isfinite(middle) ? format("%.2f", middle) : "most runs failed");
    }
    return report;
}

}  // namespace roevo
