// Ablation of coarse tracking (the paper's "Ablation Studies"): the same tracker on other points. Short
// recordings are a matter of luck, so every one is tracked several ways.
#include <algorithm>
#include <array>

#include "ablation_pieces.h"
#include "bar_chart.h"
#include "coarse_points.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "roevo-compare/report/results.h"
#include "roevo/odometry.h"
#include "study.h"

namespace roevo {
namespace {

constexpr std::size_t kVariants = kAblationVariants;
constexpr std::size_t kPiece = 120;  // frames that are held to be tracked backwards

/// Counts what it chooses.
class CountingTracker : public CoarsePointsTracker {
  public:
    CountingTracker(CoarsePoints points, const PinholeCamera& camera, const OdometryOptions& options,
                    VariantRun& result)
        : CoarsePointsTracker(points, camera, options), result_(result) {}
    PhotometricPoints choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                   const RowMotion& rows) const override {
        PhotometricPoints chosen = CoarsePointsTracker::choosePoints(edges, frame, rows);
        result_.points += static_cast<double>(chosen.size());
        ++result_.keyframes;
        return chosen;
    }

  private:
    VariantRun& result_;
};

/// One odometry on its way through a recording.
class Run {
  public:
    Run(CoarsePoints points, const StudyInput& input) {
        OdometryOptions options = input.options;
        options.mode = Mode::kCoarse;
        options.mapping.semi_dense_points = 0;  // moves no pose
        odometry_ = std::make_unique<Odometry>(
            input.camera, options, Pose::Identity(),
            std::make_unique<CountingTracker>(points, input.camera, options, result_));
    }
    Run(const Run&) = delete;  // the odometry points to it

    void process(const RgbdFrame& frame) {
        const FrameResult result = odometry_->processFrame(frame);
        ++result_.frames;
        result_.tracked += result.status == FrameStatus::kOk ||
                           (result_.frames == 1 && result.status == FrameStatus::kInitialised);
    }
    VariantRun finish(const std::vector<StampedPose>& truth) {
        try {
            if (!truth.empty()) result_.errors.add(evaluate(truth, odometry_->trajectory()));
        } catch (const std::exception& e) {
            result_.fault = e.what();
        }
        return result_;
    }

  private:
    VariantRun result_;
    std::unique_ptr<Odometry> odometry_;
};

using Runs = std::vector<std::unique_ptr<Run>>;
Runs startRuns(const StudyInput& input) {
    Runs runs;
    for (const CoarsePoints points : kAllCoarsePoints) runs.push_back(std::make_unique<Run>(points, input));
    return runs;
}

AblationPiece finish(const Runs& runs, AblationPass pass, const std::vector<StampedPose>& truth) {
    AblationPiece piece;
    piece.pass = pass;
    for (std::size_t v = 0; v < kVariants; ++v) piece.runs[v] = runs[v]->finish(truth);
    return piece;
}

AblationPiece trackBackwards(const StudyInput& input, std::vector<RgbdFrame>& frames) {
    const double mirror = frames.front().timestamp + frames.back().timestamp;
    std::reverse(frames.begin(), frames.end());
    const Runs runs = startRuns(input);
    for (RgbdFrame& frame : frames) {
        frame.timestamp = mirror - frame.timestamp;
        for (const auto& run : runs) run->process(frame);
    }
    std::vector<StampedPose> truth(input.ground_truth.rbegin(), input.ground_truth.rend());
    for (StampedPose& pose : truth) pose.timestamp = mirror - pose.timestamp;
    frames.clear();
    return finish(runs, kBackward, truth);
}

std::vector<AblationPiece> trackAllWays(const StudyInput& input, Progress& progress, std::size_t& done) {
    std::vector<AblationPiece> pieces;
    std::vector<Runs> runs;
    for (std::size_t pass = kForward; pass <= kOdd; ++pass) runs.push_back(startRuns(input));
    std::vector<RgbdFrame> held;
    const auto source = input.open();
    std::size_t count = 0;
    for (SourceFrame frame; source->next(frame);) {
        progress.update(++done);
        if (!frame.fault.empty()) continue;
        for (const auto& run : runs[kForward]) run->process(frame.frame);
        for (const auto& run : runs[count++ % 2 == 0 ? kEven : kOdd]) run->process(frame.frame);
        held.push_back({frame.frame.timestamp, frame.frame.grey.clone(), frame.frame.depth.clone(), {}});
        if (held.size() == kPiece) pieces.push_back(trackBackwards(input, held));
    }
    if (!held.empty()) pieces.push_back(trackBackwards(input, held));
    for (const AblationPass pass : {kForward, kEven, kOdd})
        pieces.push_back(finish(runs[pass], pass, input.ground_truth));
    return pieces;
}

void addRows(CsvTable& table, const std::string& recording, const std::string& pass,
             const PooledPieces& pooled) {
    for (std::size_t v = 0; v < kVariants; ++v) {
        const VariantRun& run = pooled.variants[v];
        table.add({recording, pass, label(kAllCoarsePoints[v]),
                   CsvTable::number(run.errors.metresPerSecond()),
                   CsvTable::number(run.errors.degPerSecond()), CsvTable::number(run.errors.metresPerFrame()),
                   CsvTable::number(run.errors.degPerFrame()), std::to_string(run.frames),
                   std::to_string(run.tracked),
                   CsvTable::number(run.keyframes > 0 ? run.points / run.keyframes : 0, 4),
                   std::to_string(pooled.judged), std::to_string(pooled.compared),
                   std::to_string(pooled.failed[v])});
    }
}

/// A recording in the plot.
struct Group {
    std::string name;
    PooledPieces pooled;
    std::vector<PooledPieces> passes;  // dots; none for all recordings together
};

/// Bars side by side for each recording and for all together; a dot for each way it was tracked.
void draw(StudyReport& report, const std::string& folder, const std::vector<Group>& groups) {
    BarChart chart;
    chart.title = "Coarse tracking alone: relative pose error over 1 s (RMSE)";
    chart.dots_label = "each way of tracking";
    chart.panels = {{"translation (cm/s)", {}}, {"rotation (deg/s)", {}}};
    for (std::size_t v = 0; v < kVariants; ++v)
        chart.series.push_back({label(kAllCoarsePoints[v]), static_cast<int>(v) + 1});
    for (std::size_t g = 0; g < groups.size(); ++g) {
        chart.groups.push_back(groups[g].name);
        for (BarChart::Panel& panel : chart.panels) panel.bars.emplace_back();
        for (std::size_t v = 0; v < kVariants; ++v) {
            const double x = chart.barAt(g, v);
            const auto values = [v](const PooledPieces& pooled) {
                const PooledErrors& errors = pooled.variants[v].errors;
                return std::array<double, 2>{100 * errors.metresPerSecond().value_or(kMissing),
                                             errors.degPerSecond().value_or(kMissing)};
            };
            for (std::size_t quantity = 0; quantity < 2; ++quantity) {
                chart.panels[quantity].bars.back().push_back(values(groups[g].pooled)[quantity]);
                for (const PooledPieces& pass : groups[g].passes)
                    chart.panels[quantity].dots.emplace_back(x, values(pass)[quantity]);
            }
            if (const std::size_t count = groups[g].pooled.failed[v]; count > 0)
                chart.marks.emplace_back(x, "not finished: " + std::to_string(count));
        }
    }
    addBarChart(report, folder, "ablation.svg", chart);
}

std::string faultOf(const StudyInput& input, const PooledPieces& pooled) {
    if (input.ground_truth.empty()) return input.ground_truth_note;
    for (const VariantRun& run : pooled.variants)
        if (!run.fault.empty()) return run.fault;
    return "no two poses to compare";
}

std::string summaryOf(const PooledPieces& total) {
    std::string summary = "RPE of coarse tracking over 1 s:";
    for (std::size_t v = 0; v < kVariants; ++v) {
        const PooledErrors& errors = total.variants[v].errors;
        summary += format("%s %s %.2f cm %.3f deg", v > 0 ? "," : "", label(kAllCoarsePoints[v]),
                          100 * errors.metresPerSecond().value_or(kMissing),
                          errors.degPerSecond().value_or(kMissing));
    }
    return summary;
}

}  // namespace

StudyReport studyAblation(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable table({"recording", "pass", "points_on", "rpe_translation_m_per_s", "rpe_rotation_deg_per_s",
                    "rpe_translation_m_per_frame", "rpe_rotation_deg_per_frame", "frames", "tracked",
                    "points_mean", "pieces", "pieces_compared", "pieces_not_finished"});
    std::vector<Group> groups;
    std::vector<AblationPiece> all;
    Progress progress("ablation", 0);
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        const std::vector<AblationPiece> pieces = trackAllWays(input, progress, done);
        Group group{input.name, poolPieces(pieces), {}};
        for (const AblationPass pass : {kForward, kEven, kOdd, kBackward}) {
            group.passes.push_back(poolPieces(pieces, pass));
            addRows(table, input.name, kAblationPassNames[pass], group.passes.back());
        }
        addRows(table, input.name, "all", group.pooled);
        all.insert(all.end(), pieces.begin(), pieces.end());
        if (group.pooled.judged == 0)
            report.notes.push_back(input.name + ": errors are not known: " + faultOf(input, group.pooled));
        else if (group.pooled.compared < group.pooled.judged)
            report.notes.push_back(input.name + ": of " + counted(group.pooled.judged, "piece") + ", " +
                                   std::to_string(group.pooled.compared) +
                                   " were finished by all; not finished: " + group.pooled.failures());
        if (group.pooled.judged > 0) groups.push_back(std::move(group));
    });
    progress.finish();
    const PooledPieces total = poolPieces(all);
    if (groups.size() > 1) {
        addRows(table, "all", "all", total);
        groups.push_back({"all", total, {}});
    }
    addTable(report, folder, "ablation.csv", table);
    report.notes.push_back(
        "Every recording is tracked forward, with every second frame only (twice) and, in pieces of " +
        std::to_string(kPiece) +
        " frames, backwards. A piece counts where all four finished it: errors known for every frame, and "
        "the motion measured in at least " +
        format("%.0f %% of them. ", 100 * kCompleteShare) +
        (total.compared == total.judged
             ? "All finished all of the " + counted(total.judged, "piece") + "."
             : counted(total.judged - total.compared, "piece") + " of " + std::to_string(total.judged) +
                   " left out for all, since not finished by: " + total.failures() + "."));
    const bool any = std::any_of(total.variants.begin(), total.variants.end(),
                                 [](const VariantRun& run) { return run.errors.pairsOverSecond() > 0; });
    report.summary = any ? summaryOf(total) : "no recording with errors over a second";
    if (total.compared < total.judged)
        report.summary +=
            format("; on %zu of %zu pieces, not finished: ", total.compared, total.judged) + total.failures();
    if (any) draw(report, folder, groups);
    return report;
}

}  // namespace roevo
