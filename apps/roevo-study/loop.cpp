// The error between start and end of a path that returns (the paper's Table "Loop-Closure Error"), with loops
// closed and without.
#include <cmath>
#include <stdexcept>

#include "programs/progress.h"
#include "programs/text.h"
#include "study.h"

namespace roevo {
namespace {

// A path has returned when its end is this near to its start.
constexpr double kFarthest = 0.5;       // m
constexpr double kLargestShare = 0.05;  // of the path

struct LoopRun {
    Mode mode = Mode::kBundleAdjustment;
    bool close_loops = false;
    StudyRun run;
    std::size_t closed = 0, joined = 0;
    std::optional<double> gap, turn;  // m, rad: of the motion from start to end, against the truth's
};

/// From the first pose to the last.
Pose motionOf(const std::vector<StampedPose>& poses) {
    return poses.front().T_world_camera.inverse() * poses.back().T_world_camera;
}

/// The truth of the frames under study. @throws std::runtime_error where the camera does not return
std::vector<StampedPose> returningTruth(const StudyInput& input) {
    if (input.ground_truth.empty()) throw std::runtime_error(input.ground_truth_note);
    std::vector<StampedPose> truth;
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);)
        if (const auto pose = poseAt(input.ground_truth, frame.timestamp))
            truth.push_back({frame.timestamp, *pose});
    if (truth.size() < 2) throw std::runtime_error("the ground truth is of another time");
    const double away = motionOf(truth).translation().norm(), length = pathLength(truth);
    if (away > kFarthest || away > kLargestShare * length)
        throw std::runtime_error(
            format("its end is %.2f m from its start, after %.2f m: it does not return "
                   "(at most %g m and %.0f %% of the path)",
                   away, length, kFarthest, 100 * kLargestShare));
    return truth;
}

LoopRun measure(const StudyInput& input, const std::vector<StampedPose>& truth, Mode mode, bool close_loops) {
    LoopRun result;
    result.mode = mode;
    result.close_loops = close_loops;
    OdometryOptions options = input.options;
    options.mode = mode;
    options.mapping.close_loops = close_loops;
    options.mapping.semi_dense_points = 0;  // costs time and moves no pose
    result.run = trackRecording(input, options, [&](const FrameResult& frame, const Odometry&) {
        result.closed += frame.closed_at >= 0;
        result.joined += frame.joined_at >= 0;
    });
    // Of the frames that have both
    std::vector<StampedPose> estimated;
    for (const StampedPose& end : {truth.front(), truth.back()})
        if (const auto pose = poseAt(result.run.trajectory, end.timestamp))
            estimated.push_back({end.timestamp, *pose});
    if (estimated.size() < 2) return result;
    const Pose error = motionOf(truth).inverse() * motionOf(estimated);
    result.gap = error.translation().norm();
    result.turn = Eigen::AngleAxisd(error.rotation()).angle();
    return result;
}

std::vector<LoopRun> measureAll(const StudyInput& input, const std::vector<StampedPose>& truth,
                                Progress& progress, std::size_t& done) {
    std::vector<LoopRun> runs;
    for (const Mode mode : input.modes)
        for (const bool close_loops : {false, true}) {
            if (close_loops && mode != Mode::kBundleAdjustment) continue;  // only the map closes any
            runs.push_back(measure(input, truth, mode, close_loops));
            progress.update(++done);
        }
    return runs;
}

const char* inWords(const LoopRun& run) {
    return run.close_loops ? "closed" : "not closed";
}

}  // namespace

StudyReport studyLoop(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable table({"recording", "mode", "close_loops", "path_m", "start_to_end_m", "loop_error_m",
                    "loop_error_deg", "loop_error_share", "loops_closed", "tracks_joined", "ate_m", "frames",
                    "tracked", "note"});
    std::vector<std::vector<std::string>> shown{{"recording", "mode", "loops", "path, m",
                                                 "error at the end, cm", "deg", "% of the path", "ATE, cm",
                                                 "loops closed"}};
    Progress progress("loop", 0);
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        const std::vector<StampedPose> truth = returningTruth(input);
        const double length = pathLength(truth);
        for (const LoopRun& run : measureAll(input, truth, progress, done)) {
            const auto scaled = [](std::optional<double> value, double unit) {
                return value ? std::make_optional(*value * unit) : std::nullopt;
            };
            std::optional<double> ate;
            if (run.run.evaluation) ate = run.run.evaluation->ate.translation.rmse;
            const std::string note = run.gap ? run.run.fault : "the first or the last frame has no pose";
            table.add({input.name, toString(run.mode), run.close_loops ? "yes" : "no",
                       CsvTable::number(length), CsvTable::number(motionOf(truth).translation().norm()),
                       CsvTable::number(run.gap), CsvTable::number(scaled(run.turn, 1 / kDegree)),
                       CsvTable::number(scaled(run.gap, 1 / length)), std::to_string(run.closed),
                       std::to_string(run.joined), CsvTable::number(ate), std::to_string(run.run.frames),
                       std::to_string(run.run.tracked), note});
            const auto cell = [](std::optional<double> value) { return value ? format("%.2f", *value) : ""; };
            shown.push_back({input.name, toString(run.mode), inWords(run), format("%.2f", length),
                             cell(scaled(run.gap, 100)), cell(scaled(run.turn, 1 / kDegree)),
                             cell(scaled(run.gap, 100 / length)), cell(scaled(ate, 100)),
                             std::to_string(run.closed)});
        }
    });
    progress.finish();
    addTable(report, folder, "loop.csv", table);
    report.summary = "error of the motion from start to end of " +
                     counted(inputs.size() - report.left_out.size(), "path") +
                     (inputs.size() - report.left_out.size() == 1 ? " that returns" : " that return");
    report.table = markdownTable(shown);
    report.notes.push_back(
        "Against the ground truth's motion from the first frame to the last, which need not "
        "be none; final poses. Loops are closed in mode ba only.");
    return report;
}

}  // namespace roevo
