// Whether sigmas are true: squared errors of the motion against its covariance, pooled over many ways through
// each recording.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "bar_chart.h"
#include "programs/progress.h"
#include "study.h"
#include "ways.h"

namespace roevo {
namespace {

struct Interval {
    double seconds;  // 0: from the start
    const char* name;
};
constexpr std::array<Interval, 3> kIntervals{{{1, "1 s"}, {3, "3 s"}, {0, "start"}}};

constexpr double kLeast = 0.5, kMost = 2;  // NEES over its degrees of freedom, of sigmas that are called true

/// The motions of some runs over each interval.
struct Pool {
    std::array<std::vector<JudgedMotion>, kIntervals.size()> motions;
    std::array<std::size_t, kIntervals.size()> unknown{};

    void add(const Pool& other) {
        for (std::size_t k = 0; k < kIntervals.size(); ++k) {
            motions[k].insert(motions[k].end(), other.motions[k].begin(), other.motions[k].end());
            unknown[k] += other.unknown[k];
        }
    }
    bool empty() const {
        return std::all_of(motions.begin(), motions.end(), [](const auto& m) { return m.empty(); });
    }
};

/// What was measured on one recording in one mode.
struct Judged {
    Mode mode = Mode::kBundleAdjustment;
    std::vector<Pool> runs;  ///< in the order of the ways
    Pool total;
};

/// The same as figures.
struct SigmaRow {
    std::string recording;
    Mode mode = Mode::kBundleAdjustment;
    std::array<NeesStatistics, kIntervals.size()> statistics;
};

Pool judgeRun(const StudyInput& input, const OdometryOptions& options) {
    std::vector<double> intervals;
    for (const Interval& interval : kIntervals) intervals.push_back(interval.seconds);
    MotionJudge judge(input.ground_truth, input.truth_noise, intervals);
    trackRecording(input, options, [&](const FrameResult& result, const Odometry& odometry) {
        if (!result.hasPose()) return;
        judge.add(result.timestamp, [&](std::size_t from, std::size_t to) {
            return std::pair(odometry.motion(from, to), odometry.motionCovariance(from, to));
        });
    });
    Pool pool;
    for (std::size_t k = 0; k < kIntervals.size(); ++k) {
        pool.motions[k] = judge.motions(k);
        pool.unknown[k] = judge.unknown(k);
    }
    return pool;
}

std::vector<Judged> judgeAllWays(const StudyInput& input, const std::vector<Way>& ways, Progress& progress,
                                 std::size_t& done) {
    std::vector<Judged> judged;
    for (const Mode mode : input.modes) {
        OdometryOptions options = input.options;
        options.mode = mode;
        options.mapping.semi_dense_points = 0;  // costs time and moves no pose
        Judged& of_mode = judged.emplace_back();
        of_mode.mode = mode;
        for (const Way& way : ways) {
            of_mode.runs.push_back(judgeRun(along(input, way), options));
            of_mode.total.add(of_mode.runs.back());
            progress.update(++done);
        }
    }
    if (std::all_of(judged.begin(), judged.end(), [](const Judged& j) { return j.total.empty(); }))
        throw std::runtime_error(
            "no motion can be judged: the ground truth is of another time, or all was lost");
    return judged;
}

void addRows(CsvTable& table, const StudyInput& input, Mode mode, const std::string& way, const Pool& pool) {
    for (std::size_t k = 0; k < kIntervals.size(); ++k) {
        const NeesStatistics s = neesStatistics(pool.motions[k]);
        const auto number = [&](double value) { return s.count > 0 ? CsvTable::number(value, 4) : ""; };
        table.add({input.name, toString(mode), way, kIntervals[k].name, std::to_string(s.count),
                   std::to_string(pool.unknown[k]), number(s.mean.nees), number(s.inside),
                   number(s.mean.nees_translation), number(s.mean.nees_rotation),
                   number(s.mean.error_translation), number(s.mean.sigma_translation),
                   number(s.mean.error_rotation / kDegree), number(s.mean.sigma_rotation / kDegree),
                   CsvTable::number(input.truth_noise.position),
                   CsvTable::number(input.truth_noise.orientation / kDegree)});
    }
}

std::string shown(const std::vector<SigmaRow>& rows) {
    std::vector<std::vector<std::string>> lines{{"recording", "mode"}};
    for (const Interval& interval : kIntervals)
        lines[0].push_back(interval.seconds > 0 ? std::string("over ") + interval.name : "from the start");
    for (const SigmaRow& row : rows) {
        std::vector<std::string> line{row.recording, toString(row.mode)};
        for (const NeesStatistics& s : row.statistics)
            line.push_back(s.count == 0 ? ""
                                        : format("%.2f (%.0f %%; %.2f, %.2f)", s.mean.nees, 100 * s.inside,
                                                 s.mean.nees_translation, s.mean.nees_rotation));
        lines.push_back(line);
    }
    return markdownTable(lines);
}

std::string summaryOf(const std::vector<SigmaRow>& rows) {
    std::size_t judged = 0, right = 0;
    for (const SigmaRow& row : rows)
        for (const NeesStatistics& s : row.statistics) {
            judged += s.count > 0;
            right += s.count > 0 && s.mean.nees >= kLeast && s.mean.nees <= kMost;
        }
    return format("squared error over what the covariance says: %zu of %zu means from %g to %g", right,
                  judged, kLeast, kMost);
}

void draw(StudyReport& report, const std::string& folder, const std::vector<SigmaRow>& rows,
          const std::vector<Mode>& modes) {
    BarChart chart;
    chart.title = "Squared error of the motion over what its covariance says, per degree of freedom";
    chart.unit_label = "1: sigmas are true";
    for (std::size_t m = 0; m < modes.size(); ++m)
        chart.series.push_back({toString(modes[m]), static_cast<int>(m) + 1});
    for (const Interval& interval : kIntervals)
        chart.panels.push_back(
            {interval.seconds > 0 ? std::string("over ") + interval.name : "from the start", {}});
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const bool first = r % modes.size() == 0;  // of the recording
        if (first) chart.groups.push_back(rows[r].recording);
        for (std::size_t k = 0; k < kIntervals.size(); ++k) {
            if (first) chart.panels[k].bars.emplace_back();
            const NeesStatistics& s = rows[r].statistics[k];
            chart.panels[k].bars.back().push_back(s.count > 0 ? s.mean.nees : kMissing);
        }
    }
    addBarChart(report, folder, "sigmas.svg", chart);
}

}  // namespace

StudyReport studySigmas(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    const std::vector<std::string> head{"recording",
                                        "mode",
                                        "way",
                                        "over",
                                        "motions",
                                        "unknown",
                                        "nees",
                                        "inside_95",
                                        "nees_translation",
                                        "nees_rotation",
                                        "error_translation_m",
                                        "sigma_translation_m",
                                        "error_rotation_deg",
                                        "sigma_rotation_deg",
                                        "truth_sigma_m",
                                        "truth_sigma_deg"};
    CsvTable pooled(head), of_runs(head);
    std::vector<SigmaRow> rows;
    Progress progress("sigmas", 0);
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        if (input.ground_truth.empty()) throw std::runtime_error(input.ground_truth_note);
        const std::vector<Way> ways = waysThrough(input);
        for (const Judged& judged : judgeAllWays(input, ways, progress, done)) {
            for (std::size_t w = 0; w < ways.size(); ++w)
                addRows(of_runs, input, judged.mode, ways[w].name(), judged.runs[w]);
            addRows(pooled, input, judged.mode, "all", judged.total);
            rows.push_back({input.name, judged.mode, {}});
            for (std::size_t k = 0; k < kIntervals.size(); ++k)
                rows.back().statistics[k] = neesStatistics(judged.total.motions[k]);
        }
    });
    progress.finish();
    addTable(report, folder, "sigmas.csv", pooled);
    addTable(report, folder, "sigmas_runs.csv", of_runs);
    draw(report, folder, rows, inputs.front().modes);
    report.summary = summaryOf(rows);
    report.table = shown(rows);
    report.notes.push_back(format(
        "Mean NEES per degree of freedom (share inside the 95 %% ellipsoid; translation alone, rotation "
        "alone) of motions as they are known then, all ways through a recording pooled; 1 and 95 %% would be "
        "right. The ground truth is taken to err by %g mm and %g degrees per axis.",
        1e3 * inputs.front().truth_noise.position, inputs.front().truth_noise.orientation / kDegree));
    return report;
}

}  // namespace roevo
