// How accurate the odometry is, told by many ways through each recording, since one run is one throw of a
// die.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "bar_chart.h"
#include "programs/progress.h"
#include "study.h"
#include "ways.h"

namespace roevo {
namespace {

constexpr double kMostWorse = 1.05;  // final over live ATE, that the map may leave

/// What the map refused, by reason.
using Refusals = std::map<MapRefusal::Kind, std::size_t>;

std::size_t sum(const Refusals& refusals) {
    std::size_t count = 0;
    for (const auto& [kind, times] : refusals) count += times;
    return count;
}

std::string inWords(const Refusals& refusals) {
    std::string text;
    for (const auto& [kind, times] : refusals)
        text += (text.empty() ? "" : "; ") + std::string(toString(kind)) + ": " + std::to_string(times);
    return text;
}

/// One way through a recording.
struct WayRun {
    Way way;
    std::optional<double> final_ate, live_ate;  // m
    double tracked = 0;                         // share of the frames
    Refusals refusals;
    std::string fault;

    std::optional<double> ratio() const {
        if (!final_ate || !live_ate || !(*live_ate > 0)) return std::nullopt;
        return *final_ate / *live_ate;
    }
};

/// All ways through one recording in one mode.
struct Spread {
    std::string recording;
    Mode mode = Mode::kBundleAdjustment;
    std::vector<WayRun> runs;

    /// Ascending, of the runs that have it.
    template <class Get>
    std::vector<double> values(Get get) const {
        std::vector<double> values;
        for (const WayRun& run : runs)
            if (const std::optional<double> value = get(run)) values.push_back(*value);
        std::sort(values.begin(), values.end());
        return values;
    }
    std::vector<double> finals() const {
        return values([](const WayRun& run) { return run.final_ate; });
    }
    std::vector<double> ratios() const {
        return values([](const WayRun& run) { return run.ratio(); });
    }
    double leastTracked() const {
        double least = 1;
        for (const WayRun& run : runs) least = std::min(least, run.tracked);
        return least;
    }
    Refusals refusals() const {
        Refusals all;
        for (const WayRun& run : runs)
            for (const auto& [kind, times] : run.refusals) all[kind] += times;
        return all;
    }
};

WayRun measure(const StudyInput& recording, Mode mode, const Way& way) {
    const StudyInput input = along(recording, way);
    OdometryOptions options = input.options;
    options.mode = mode;
    options.mapping.semi_dense_points = 0;  // costs time and moves no pose
    WayRun result;
    result.way = way;
    const StudyRun run = trackRecording(input, options, [&](const FrameResult& frame, const Odometry&) {
        for (const MapRefusal& refusal : frame.map_refusals) ++result.refusals[refusal.kind];
    });
    result.fault = run.fault;
    if (run.frames > 0) result.tracked = static_cast<double>(run.tracked) / static_cast<double>(run.frames);
    if (!run.evaluation) return result;
    result.final_ate = run.evaluation->ate.translation.rmse;
    result.live_ate = evaluate(input.ground_truth, run.live).ate.translation.rmse;
    return result;
}

void addRows(CsvTable& pooled, CsvTable& of_runs, const Spread& spread) {
    const std::vector<double> ates = spread.finals(), ratios = spread.ratios();
    const auto lives = spread.values([](const WayRun& run) { return run.live_ate; });
    const auto first = [](const std::vector<double>& values) {
        return values.empty() ? "" : CsvTable::number(values.front());
    };
    const auto last = [](const std::vector<double>& values) {
        return values.empty() ? "" : CsvTable::number(values.back());
    };
    pooled.add({spread.recording, toString(spread.mode), std::to_string(spread.runs.size()),
                std::to_string(spread.runs.size() - ates.size()), CsvTable::number(spread.leastTracked(), 4),
                CsvTable::number(median(ates)), first(ates), last(ates), CsvTable::number(median(lives)),
                CsvTable::number(median(ratios)), last(ratios), std::to_string(sum(spread.refusals())),
                inWords(spread.refusals())});
    for (const WayRun& run : spread.runs)
        of_runs.add({spread.recording, toString(spread.mode), run.way.name(),
                     CsvTable::number(run.tracked, 4), CsvTable::number(run.final_ate),
                     CsvTable::number(run.live_ate), CsvTable::number(run.ratio()),
                     std::to_string(sum(run.refusals)), inWords(run.refusals), run.fault});
}

std::string shown(const std::vector<Spread>& spreads) {
    std::vector<std::vector<std::string>> lines{{"recording", "mode", "ATE, cm: median", "least to largest",
                                                 "final / live: median", "worst", "least tracked",
                                                 "refusals of the map"}};
    for (const Spread& spread : spreads) {
        const std::vector<double> ates = spread.finals(), ratios = spread.ratios();
        const Refusals refusals = spread.refusals();
        std::vector<std::string> line{spread.recording, toString(spread.mode)};
        if (ates.empty())
            line.insert(line.end(), {"", ""});
        else
            line.insert(line.end(), {format("%.2f", 100 * *median(ates)),
                                     format("%.2f to %.2f", 100 * ates.front(), 100 * ates.back())});
        if (ratios.empty())
            line.insert(line.end(), {"", ""});
        else
            line.insert(line.end(), {format("%.3f", *median(ratios)), format("%.3f", ratios.back())});
        line.push_back(format("%.0f %%", std::floor(100 * spread.leastTracked())));
        line.push_back(refusals.empty() ? "0"
                                        : std::to_string(sum(refusals)) + " (" + inWords(refusals) + ")");
        lines.push_back(line);
    }
    return markdownTable(lines);
}

std::string summaryOf(const std::vector<Spread>& spreads) {
    std::size_t runs = 0, failed = 0, worse = 0;
    double worst = 0;
    for (const Spread& spread : spreads) {
        runs += spread.runs.size();
        failed += spread.runs.size() - spread.finals().size();
        for (const double ratio : spread.ratios()) {
            worst = std::max(worst, ratio);
            worse += ratio > kMostWorse;
        }
    }
    return format(
        "%zu runs, %zu without errors; final poses worse than live ones by more than %.0f %% in %zu, at "
        "worst %.3f times",
        runs, failed, 100 * (kMostWorse - 1), worse, worst);
}

void draw(StudyReport& report, const std::string& folder, const std::vector<Spread>& spreads,
          const std::vector<Mode>& modes) {
    BarChart chart;
    chart.title = "Absolute trajectory error: median of all ways through a recording";
    chart.dots_label = "each way";
    chart.panels = {{"ATE (cm)", {}}, {"ATE, final / live poses", {}}};
    for (std::size_t m = 0; m < modes.size(); ++m)
        chart.series.push_back({toString(modes[m]), static_cast<int>(m) + 1});
    for (std::size_t i = 0; i < spreads.size(); ++i) {
        const std::size_t mode = i % modes.size();
        if (mode == 0) {
            chart.groups.push_back(spreads[i].recording);
            for (BarChart::Panel& panel : chart.panels) panel.bars.emplace_back();
        }
        const double x = chart.barAt(chart.groups.size() - 1, mode);
        const auto add = [&](BarChart::Panel& panel, const std::vector<double>& values, double unit) {
            panel.bars.back().push_back(unit * median(values).value_or(kMissing));
            for (const double value : values) panel.dots.emplace_back(x, unit * value);
        };
        add(chart.panels[0], spreads[i].finals(), 100);
        add(chart.panels[1], spreads[i].ratios(), 1);
    }
    addBarChart(report, folder, "distribution.svg", chart);
}

}  // namespace

StudyReport studyDistribution(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable pooled({"recording", "mode", "runs", "failed", "tracked_least", "ate_median_m", "ate_least_m",
                     "ate_largest_m", "ate_live_median_m", "final_over_live_median", "final_over_live_worst",
                     "refusals", "refusal_reasons"});
    CsvTable of_runs({"recording", "mode", "way", "tracked", "ate_m", "ate_live_m", "final_over_live",
                      "refusals", "refusal_reasons", "note"});
    std::vector<Spread> spreads;
    Progress progress("distribution", 0);
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        if (input.ground_truth.empty()) throw std::runtime_error(input.ground_truth_note);
        const std::vector<Way> ways = waysThrough(input);
        std::vector<Spread> of_input;
        for (const Mode mode : input.modes) {
            of_input.push_back({input.name, mode, {}});
            for (const Way& way : ways) {
                of_input.back().runs.push_back(measure(input, mode, way));
                progress.update(++done);
            }
        }
        if (std::all_of(of_input.begin(), of_input.end(),
                        [](const Spread& spread) { return spread.finals().empty(); }))
            throw std::runtime_error(of_input.front().runs.front().fault);
        for (Spread& spread : of_input) {
            addRows(pooled, of_runs, spread);
            for (const WayRun& run : spread.runs)
                if (!run.final_ate)
                    report.notes.push_back(spread.recording + ", " + toString(spread.mode) + ", " +
                                           run.way.name() + ": no errors: " + run.fault);
            spreads.push_back(std::move(spread));
        }
    });
    progress.finish();
    addTable(report, folder, "distribution.csv", pooled);
    addTable(report, folder, "distribution_runs.csv", of_runs);
    draw(report, folder, spreads, inputs.front().modes);
    report.summary = summaryOf(spreads);
    report.table = shown(spreads);
    return report;
}

}  // namespace roevo
