// Ablation of coarse tracking (the paper's "Ablation Studies"): the same tracker on other points. Short
// recordings are a matter of luck, so every one is tracked several ways.
#include <algorithm>
#include <cmath>
#include <limits>

#include "coarse_points.h"
#include "roevo/odometry.h"
#include "study.h"
#include "support/gnuplot.h"
#include "support/progress.h"

namespace roevo {
namespace {

constexpr std::size_t kVariants = std::size(kAllCoarsePoints);
constexpr std::size_t kPiece = 120;  // frames that are held to be tracked backwards
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum Pass { kForward, kEven, kOdd, kBackward, kPasses };
constexpr const char* kPassNames[] = {"forward", "even frames", "odd frames", "backwards"};

/// Errors of several runs taken together.
struct PooledErrors {
    double second_t = 0, second_r = 0, frame_t = 0, frame_r = 0;  // sums of squares: m, deg
    double seconds = 0, pairs = 0;                                // how many
    std::size_t frames = 0, tracked = 0;
    double points = 0, keyframes = 0;  // sums over the keyframes

    void add(const Evaluation& e) {
        const auto n = static_cast<double>(e.rpe_second.translation.count);
        second_t += n * std::pow(e.rpe_second.translation.rmse, 2);
        second_r += n * std::pow(e.rpe_second.rotation.rmse, 2);
        seconds += n;
        const auto m = static_cast<double>(e.rpe_frame.translation.count);
        frame_t += m * std::pow(e.rpe_frame.translation.rmse, 2);
        frame_r += m * std::pow(e.rpe_frame.rotation.rmse, 2);
        pairs += m;
    }
    void add(const PooledErrors& o) {
        second_t += o.second_t, second_r += o.second_r, frame_t += o.frame_t, frame_r += o.frame_r;
        seconds += o.seconds, pairs += o.pairs, frames += o.frames, tracked += o.tracked;
        points += o.points, keyframes += o.keyframes;
    }
    static std::optional<double> rmse(double sum, double n) {
        return n > 0 ? std::optional<double>(std::sqrt(sum / n)) : std::nullopt;
    }
    std::optional<double> metresPerSecond() const { return rmse(second_t, seconds); }
    std::optional<double> degPerSecond() const { return rmse(second_r, seconds); }
    std::optional<double> metresPerFrame() const { return rmse(frame_t, pairs); }
    std::optional<double> degPerFrame() const { return rmse(frame_r, pairs); }
};

/// One odometry on its way through a recording.
class Run {
  public:
    Run(CoarsePoints points, const StudyInput& input) {
        OdometryOptions options = input.options;
        options.mode = Mode::kCoarse;
        options.mapping.semi_dense_points = 0;  // moves no pose
        OdometryStages stages = coarseStages(points, input.camera, options);
        stages.photometric_points = [this, sample = stages.photometric_points](const KeyframeView& view) {
            PhotometricPoints chosen = sample(view);
            errors_.points += static_cast<double>(chosen.size());
            ++errors_.keyframes;
            return chosen;
        };
        odometry_ = std::make_unique<Odometry>(input.camera, options, Pose::Identity(), stages);
    }
    Run(const Run&) = delete;  // the odometry points to it

    void process(const RgbdFrame& frame) {
        const FrameResult result = odometry_->processFrame(frame);
        ++errors_.frames;
        errors_.tracked += result.status == FrameStatus::kOk ||
                           (errors_.frames == 1 && result.status == FrameStatus::kInitialised);
    }
    /// @param fault  gets why there are no errors, in words
    PooledErrors finish(const std::vector<StampedPose>& truth, std::string& fault) {
        if (truth.empty()) return errors_;
        try {
            errors_.add(evaluate(truth, odometry_->trajectory()));
        } catch (const std::exception& e) {
            fault = e.what();
        }
        return errors_;
    }

  private:
    PooledErrors errors_;
    std::unique_ptr<Odometry> odometry_;
};

using Runs = std::vector<std::unique_ptr<Run>>;
Runs startRuns(const StudyInput& input) {
    Runs runs;
    for (const CoarsePoints points : kAllCoarsePoints) runs.push_back(std::make_unique<Run>(points, input));
    return runs;
}

using Table = std::vector<std::vector<PooledErrors>>;  // [pass][variant]

void trackBackwards(const StudyInput& input, std::vector<RgbdFrame>& piece, Table& errors) {
    if (piece.empty()) return;
    const double mirror = piece.front().timestamp + piece.back().timestamp;
    std::reverse(piece.begin(), piece.end());
    Runs runs = startRuns(input);
    for (RgbdFrame& frame : piece) {
        frame.timestamp = mirror - frame.timestamp;
        for (const auto& run : runs) run->process(frame);
    }
    std::vector<StampedPose> truth(input.ground_truth.rbegin(), input.ground_truth.rend());
    for (StampedPose& pose : truth) pose.timestamp = mirror - pose.timestamp;
    for (std::size_t v = 0; v < kVariants; ++v) {
        std::string fault;  // a short piece may have none
        errors[kBackward][v].add(runs[v]->finish(truth, fault));
    }
    piece.clear();
}

Table trackAllWays(const StudyInput& input, Progress& progress, std::size_t& done, std::string& fault) {
    Table errors(kPasses, std::vector<PooledErrors>(kVariants));
    std::vector<Runs> runs;
    for (int pass = kForward; pass <= kOdd; ++pass) runs.push_back(startRuns(input));
    std::vector<RgbdFrame> piece;
    const auto source = input.open();
    std::size_t count = 0;
    for (SourceFrame frame; source->next(frame);) {
        progress.update(++done);
        if (!frame.fault.empty()) continue;
        for (const auto& run : runs[kForward]) run->process(frame.frame);
        for (const auto& run : runs[count++ % 2 == 0 ? kEven : kOdd]) run->process(frame.frame);
        piece.push_back({frame.frame.timestamp, frame.frame.grey.clone(), frame.frame.depth.clone(), {}});
        if (piece.size() == kPiece) trackBackwards(input, piece, errors);
    }
    trackBackwards(input, piece, errors);
    for (int pass = kForward; pass <= kOdd; ++pass) {
        const auto p = static_cast<std::size_t>(pass);
        for (std::size_t v = 0; v < kVariants; ++v)
            errors[p][v] = runs[p][v]->finish(input.ground_truth, fault);
    }
    return errors;
}

void addRow(CsvTable& table, const std::string& recording, const std::string& pass, std::size_t variant,
            const PooledErrors& e) {
    table.add({recording, pass, label(kAllCoarsePoints[variant]), CsvTable::number(e.metresPerSecond()),
               CsvTable::number(e.degPerSecond()), CsvTable::number(e.metresPerFrame()),
               CsvTable::number(e.degPerFrame()), std::to_string(e.frames), std::to_string(e.tracked),
               CsvTable::number(e.keyframes > 0 ? e.points / e.keyframes : 0, 4)});
}

/// Bars side by side for each recording and for all together; a dot for each way it was tracked.
void draw(StudyReport& report, const std::string& folder, const std::vector<std::string>& names,
          const std::vector<Table>& errors, const std::vector<std::vector<PooledErrors>>& pooled) {
    std::vector<std::vector<double>> bars, dots;
    for (std::size_t r = 0; r < pooled.size(); ++r) {
        bars.push_back({static_cast<double>(r)});
        for (const PooledErrors& e : pooled[r]) {
            bars.back().push_back(100 * e.metresPerSecond().value_or(kMissing));
            bars.back().push_back(e.degPerSecond().value_or(kMissing));
        }
        if (r >= errors.size()) continue;
        for (const auto& pass : errors[r])
            for (std::size_t v = 0; v < kVariants; ++v)
                dots.push_back({static_cast<double>(r) + 0.2 * (static_cast<double>(v) - 1.5),
                                100 * pass[v].metresPerSecond().value_or(kMissing),
                                pass[v].degPerSecond().value_or(kMissing)});
    }
    std::string tics;
    for (std::size_t r = 0; r < names.size(); ++r)
        tics += (r > 0 ? ", " : "") + gnuplotText(names[r]) + ' ' + std::to_string(r);
    std::string script = gnuplotData("bars", bars) + gnuplotData("dots", dots) +
                         "set multiplot layout 2,1\nset xtics rotate by -15 (" + tics + ")\n" +
                         format("set xrange [-0.6:%g]\n", static_cast<double>(names.size()) - 0.4) +
                         "set boxwidth 0.18\nset lmargin 9\nset grid noxtics\nset yrange [0:*]\n"
                         "set key outside center top horizontal Left reverse maxrows 2\n";
    for (int quantity = 0; quantity < 2; ++quantity) {
        script += quantity == 0
                      ? "set title 'Coarse tracking alone: relative pose error over one second (RMSE)'\n"
                        "set ylabel 'translation (cm/s)'\nplot "
                      : "unset title\nunset key\nset ylabel 'rotation (deg/s)'\nplot ";
        for (std::size_t v = 0; v < kVariants; ++v)
            script += format("$bars using ($1%+.2f):%zu with boxes lt %zu title ",
                             0.2 * (static_cast<double>(v) - 1.5),
                             2 + 2 * v + static_cast<std::size_t>(quantity), v + 1) +
                      gnuplotText(label(kAllCoarsePoints[v])) + ", ";
        script += format("$dots using 1:%d with points pt 7 ps 0.35 lc rgb '#222222' title 'each way'\n",
                         2 + quantity);
    }
    addPlot(report, folder, "ablation.svg", script + "unset multiplot\n", 980, 680);
}

}  // namespace

StudyReport studyAblation(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable table({"recording", "pass", "points_on", "rpe_translation_m_per_s", "rpe_rotation_deg_per_s",
                    "rpe_translation_m_per_frame", "rpe_rotation_deg_per_frame", "frames", "tracked",
                    "points_mean"});
    std::vector<std::string> names;
    std::vector<Table> all;
    std::vector<std::vector<PooledErrors>> pooled;
    std::vector<PooledErrors> total(kVariants);
    Progress progress("ablation", 0);
    std::size_t done = 0;
    for (const StudyInput& input : inputs) {
        std::string fault = input.ground_truth.empty() ? input.ground_truth_note : "";
        const Table errors = trackAllWays(input, progress, done, fault);
        std::vector<PooledErrors> together(kVariants);
        for (std::size_t pass = 0; pass < kPasses; ++pass) {
            for (std::size_t v = 0; v < kVariants; ++v) {
                addRow(table, input.name, kPassNames[pass], v, errors[pass][v]);
                together[v].add(errors[pass][v]);
            }
        }
        for (std::size_t v = 0; v < kVariants; ++v) addRow(table, input.name, "all", v, together[v]);
        if (!fault.empty()) report.notes.push_back(input.name + ": errors are not known: " + fault);
        if (!together[0].metresPerSecond()) continue;
        for (std::size_t v = 0; v < kVariants; ++v) total[v].add(together[v]);
        names.push_back(input.name);
        all.push_back(errors);
        pooled.push_back(together);
    }
    progress.finish();
    if (names.size() > 1) {
        for (std::size_t v = 0; v < kVariants; ++v) addRow(table, "all", "all", v, total[v]);
        names.push_back("all");
        pooled.push_back(total);
    }
    addTable(report, folder, "ablation.csv", table);
    report.notes.push_back(
        "ablation: every recording is tracked forward, with every second frame only (twice) and, in pieces "
        "of " +
        std::to_string(kPiece) + " frames, backwards");
    if (names.empty()) {
        report.summary = "no recording with errors over a second";
        return report;
    }
    draw(report, folder, names, all, pooled);
    report.summary = "RPE of coarse tracking over 1 s:";
    for (std::size_t v = 0; v < kVariants; ++v)
        report.summary += format("%s %s %.2f cm %.3f deg", v > 0 ? "," : "", label(kAllCoarsePoints[v]),
                                 100 * total[v].metresPerSecond().value_or(kMissing),
                                 total[v].degPerSecond().value_or(kMissing));
    return report;
}

}  // namespace roevo
