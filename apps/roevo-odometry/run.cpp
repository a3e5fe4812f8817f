#include "run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <thread>

#include "evaluation/scale_check.h"
#include "evaluation/trajectory_io.h"
#include "mrpt_outputs.h"
#include "programs/ahead.h"
#include "programs/atomic_file.h"
#include "programs/interrupt.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "programs/progress.h"
#include "programs/whole_outputs.h"
#include "recordings/frame_source.h"
#include "roevo_mrpt/config_file.h"
#include "roevo_mrpt/map_file.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

FrameResult rejected(const SourceFrame& frame) {
    FrameResult result;
    result.timestamp = frame.timestamp;
    result.status = FrameStatus::kRejected;
    result.reason = frame.fault;
    return result;
}

std::size_t expectedFrames(const FrameSource& source, const RunSettings& settings) {
    if (source.size() == 0) return 0;
    const std::size_t left = source.size() - std::min(settings.skip, source.size());
    return settings.first > 0 ? std::min(left, settings.first) : left;
}

const std::vector<std::string> kResults = {
    "trajectory.txt",     "trajectory_live.txt", "trajectory_robot.txt",
    "keyframes.txt",      "map.3Dscene",         "map.ply",
    "map_semi_dense.ply", "config_used.ini",     "frames.csv",
    "summary.json",       "trajectory_truth.txt"};

// What is written besides the results must not take the place of what is read, or of anything else written.
void checkNames(const RunSettings& settings, const std::string& ground_truth) {
    const auto isResult = [&](const std::string& file) {
        return std::any_of(kResults.begin(), kResults.end(), [&](const std::string& name) {
            return isSameFile(file, (fs::path(settings.output_dir) / name).string());
        });
    };
    if (isResult(ground_truth))
        throw UsageError("the ground truth " + ground_truth +
                         " is what the run writes itself; give another --output");
    const std::string& pairs = settings.choice.folder.associations;
    const std::pair<const char*, std::string> named[] = {{"--map-in", settings.map_in},
                                                         {"--map-out", settings.map_out},
                                                         {"--covariances", settings.covariances},
                                                         {"--simplemap", settings.simple_map},
                                                         {"--rawlog-with-poses", settings.rawlog_with_poses}};
    for (std::size_t i = 1; i < std::size(named); ++i) {
        const auto& [option, file] = named[i];
        const auto refuse = [&, option = option, &file = file](const std::string& what) {
            throw UsageError(std::string(option) + " " + file + " is what " + what + "; give another name");
        };
        keepInputs(option, file, {ground_truth, settings.choice.mask, settings.config, pairs});
        if (!pairs.empty()) keepInputs(option, file, {(fs::path(settings.input) / pairs).string()});
        // Results may lie inside of the recording, and those of an earlier run be replaced
        if (!isWithin(file, settings.output_dir) || isSameFile(settings.output_dir, settings.input))
            keepInputs(option, file, {settings.input});
        if (isResult(file)) refuse("the run writes itself");
        for (std::size_t k = i == 1 ? 1 : 0; k < i; ++k)  // a map may be written over the one that was read
            if (isSameFile(file, named[k].second)) refuse(std::string(named[k].first) + " names");
    }
}

// There before any work is done, so that a wrong path costs none.
void open(std::optional<AtomicFile>& file, const std::string& name) {
    if (!name.empty()) file.emplace(name).stream();
}

/// @return why there is none: the other results are kept all the same
std::string saveMap(const Odometry& odometry, const std::string& name, std::optional<AtomicFile>& file,
                    RunReport& report) {
    try {
        report.map_out = {name, odometry.saveMap(file->stream())};
        return {};
    } catch (const std::runtime_error& error) {
        file.reset();
        return "cannot write " + name + ": " + error.what() + " (all other results are written)";
    }
}

constexpr double kLongestGap = 1;  // s; a recording that stood still, or a stray stamp, is not waited for

// Hands frames out at the pace of their stamps, as a camera would.
class FrameClock {
  public:
    // Waits for the frame's time. False when that is past by more than one frame.
    bool await(double timestamp) {
        const auto now = std::chrono::steady_clock::now();
        const double interval = started_ ? timestamp - last_ : 0;
        if (!started_ || std::abs(interval) > kLongestGap) {
            started_ = true;
            start_ = now;
            first_ = timestamp;
        }
        last_ = timestamp;
        const auto due = start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                      std::chrono::duration<double>(timestamp - first_));
        if (now - due > std::chrono::duration<double>(interval) && interval > 0) return false;
        std::this_thread::sleep_until(due);
        return true;
    }

  private:
    bool started_ = false;
    std::chrono::steady_clock::time_point start_;
    double first_ = 0, last_ = 0;  // s
};

// On its way from the input to the tracker.
struct FrameAhead {
    SourceFrame source;      // without its images once they are prepared
    PreparedFrame prepared;  // where it is not a fault, and not to come by the clock
};

FrameResult track(Odometry& odometry, FrameAhead& frame, bool prepared) {
    if (!frame.source.fault.empty()) return rejected(frame.source);
    return prepared ? odometry.processFrame(std::move(frame.prepared))
                    : odometry.processFrame(frame.source.frame);
}

// Feeds every frame to the odometry; the report gets one record for each. Decoding, edges and tracking go on
// at the same time, each of another frame.
void processFrames(FrameSource& source, Odometry& odometry, const RunSettings& settings, RunReport& report) {
    Progress progress("tracking", expectedFrames(source, settings), !settings.quiet);
    DepthScaleCheck depth_scale;
    FrameClock clock;
    const auto decode = [&, read = std::size_t{0}]() mutable -> std::optional<FrameAhead> {
        FrameAhead ahead;
        if ((settings.first > 0 && read++ == settings.first) || !source.next(ahead.source))
            return std::nullopt;
        return ahead;
    };
    const auto findEdges = [&](FrameAhead& ahead) {
        if (const std::string fault = depth_scale.faultOf(ahead.source); !fault.empty())
            throw std::runtime_error(settings.input + ": " + fault);
        if (settings.realtime || !ahead.source.fault.empty()) return;
        ahead.prepared = odometry.prepareFrame(std::move(ahead.source.frame));
        ahead.source.frame = RgbdFrame();
    };
    Ahead<FrameAhead> frames(decode, findEdges, threadCount(settings.options.threads));
    while (auto ahead = frames.next()) {
        SourceFrame& frame = ahead->source;
        const bool dropped = settings.realtime && frame.fault.empty() && !clock.await(frame.timestamp);
        if (dropped) frame.fault = "dropped: the one before was not done in time";
        const FrameResult result = track(odometry, *ahead, !settings.realtime);
        report.frames.push_back({result, frame.ms_decode, dropped});
        if (frame.camera_on_robot && result.hasPose()) {
            report.camera_on_robot.push_back({frame.timestamp, *frame.camera_on_robot});
            report.mounted = report.mounted || frame.mounted;
        }
        const std::size_t done = report.frames.size();
        const double of_first =
            settings.first > 0 ? static_cast<double>(done) / static_cast<double>(settings.first) : 0;
        progress.update(done, std::max(frame.progress, of_first));
    }
    progress.finish();
}

// Begins with the map that was asked for.
void loadMap(const RunSettings& settings, Odometry& odometry, RunReport& report) {
    const MapUse use = settings.localise_only ? MapUse::kLocalise : MapUse::kExtend;
    const int keyframes = loadMapFile(settings.map_in, odometry, use);
    report.map_in = LoadedMap{settings.map_in, keyframes, settings.localise_only};
}

void evaluateRun(RunReport& report, const GroundTruth& ground_truth) {
    if (ground_truth.poses.empty()) {
        report.evaluation_fault = ground_truth.note;
        return;
    }
    try {
        report.evaluation = evaluate(ground_truth.poses, report.trajectory);
        report.scale_warning =
            scaleContradiction(ground_truth.poses, report.trajectory, report.evaluation->pairs);
    } catch (const std::exception& e) {
        report.evaluation_fault = e.what();
    }
}

// What the run was compared with; empty where it was not.
// Moves it onto the trajectory.
std::vector<StampedPose> aligned(std::vector<StampedPose> ground_truth, const RunReport& report) {
    for (StampedPose& pose : ground_truth)
        pose.T_world_camera = report.evaluation->ate.T_reference_estimate.inverse() * pose.T_world_camera;
    return ground_truth;
}

std::vector<StampedPose> keyframePoses(const RunReport& report) {
    std::vector<StampedPose> poses;
    for (const KeyframeInfo& k : report.keyframes) poses.push_back({k.timestamp, k.T_world_camera});
    return poses;
}

// @param content  with the map and the surface already in it
void writeMap(WholeOutputs& files, const RunReport& report, const Odometry& odometry, SceneContent content,
              std::vector<StampedPose> reference) {
    // The other modes do not tell which edges are the same
    if (report.mode == Mode::kBundleAdjustment) content.keyframe_edges = odometry.keyframeEdges();
    content.trajectory = report.trajectory;
    content.keyframes = report.keyframes;
    content.camera = report.camera.undistorted();
    content.reference = std::move(reference);
    saveScene(files.path("map.3Dscene"), *buildScene(content));
    InterruptGuard::check();
    savePly(files.path("map.ply"), content.map);
    InterruptGuard::check();
    savePointsPly(files.path("map_semi_dense.ply"), content.semi_dense);
    InterruptGuard::check();
}

RunReport reportOn(const FrameSource& source, const RunSettings& settings) {
    RunReport report;
    report.command = settings.command;
    report.input = settings.input;
    report.kind = source.kind();
    report.camera = source.camera();
    report.camera_source = source.cameraSource();
    report.mode = settings.options.mode;
    return report;
}

void printInput(const RunReport& report, const std::vector<std::string>& notes) {
    std::printf("input       %s (%s), %d x %d, intrinsics from %s\n", report.input.c_str(),
                report.kind.c_str(), report.camera.width, report.camera.height, report.camera_source.c_str());
    for (const std::string& note : notes) std::printf("note        %s\n", note.c_str());
    std::fflush(stdout);
}

/// What becomes of keyframes and map when the recording ends.
SceneContent finishMap(Odometry& odometry, RunReport& report) {
    const auto tracked = std::chrono::steady_clock::now();
    report.final_refusals = odometry.refineAll();
    report.final_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - tracked).count();
    report.trajectory = odometry.trajectory();
    report.keyframes = odometry.keyframes();
    if (report.map_in)  // those of this recording
        report.keyframes.erase(
            std::remove_if(report.keyframes.begin(), report.keyframes.end(),
                           [&](const KeyframeInfo& k) { return k.id < report.map_in->keyframes; }),
            report.keyframes.end());
    SceneContent content;
    content.map = odometry.map();
    content.semi_dense = odometry.semiDense();
    report.semi_dense_points = content.semi_dense.size();
    report.map_edges = content.map.size();
    for (const MapEdge& edge : content.map) report.map_points += edge.points.size();
    return content;
}

}  // namespace

RunReport runOdometry(const RunSettings& settings) {
    const auto start = std::chrono::steady_clock::now();
    auto source = openSource(settings.input, settings.choice);
    const GroundTruth ground_truth = source->groundTruth();
    checkNames(settings, ground_truth.file);
    RunReport report = reportOn(*source, settings);
    Odometry odometry(source->camera(), settings.options);
    if (!settings.map_in.empty()) loadMap(settings, odometry, report);
    prepareOutputFolder(settings.output_dir);
    WholeOutputs files(settings.output_dir, kResults);
    std::optional<AtomicFile> map_file, covariances;  // opened now, else nothing is begun
    open(map_file, settings.map_out);
    open(covariances, settings.covariances);
    MrptOutputs for_mrpt(settings, *source);

    report.ground_truth = ground_truth.file;
    if (!settings.quiet) printInput(report, source->notes());

    skipFrames(*source, settings.skip, settings.input);
    processFrames(*source, odometry, settings, report);
    report.warning = source->warning();
    source.reset();

    SceneContent content = finishMap(odometry, report);
    report.readout_time = odometry.readoutTime();
    report.readout_learned = odometry.options().sensor.estimate_readout;

    const InterruptGuard guard;  // a signal does not leave half of the results
    const std::string failure = report.failure();
    std::string no_map;
    if (failure.empty()) {
        evaluateRun(report, ground_truth);
        writeTumTrajectory(files.path("trajectory.txt"), report.trajectory);
        writeTumTrajectory(files.path("trajectory_live.txt"), odometry.liveTrajectory());
        writeTumTrajectory(files.path("keyframes.txt"), keyframePoses(report));
        if (report.mounted)
            writeTumTrajectory(files.path("trajectory_robot.txt"),
                               robotTrajectory(report.trajectory, report.camera_on_robot));
        std::vector<StampedPose> reference;
        if (report.evaluation) reference = coveredPart(ground_truth.poses, report.trajectory);
        if (!reference.empty()) writeTumTrajectory(files.path("trajectory_truth.txt"), reference);
        writeMap(files, report, odometry, std::move(content), aligned(std::move(reference), report));
        if (map_file) no_map = saveMap(odometry, settings.map_out, map_file, report);
        for_mrpt.write(report, odometry);
    }
    saveConfigFile(files.path("config_used.ini"), odometry.options());
    writeTextAtomically(files.path("frames.csv"), framesCsv(report));
    report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    writeTextAtomically(files.path("summary.json"), summaryJson(report));
    if (covariances) covariances->stream() << covariancesText(report);
    for (auto* file :
         {&covariances, &map_file})  // else the results would get their names, and these would not
        if (*file) (*file)->close();
    files.commit();
    for_mrpt.commit();
    if (covariances && failure.empty()) covariances->commit();
    if (!report.map_out.file.empty()) map_file->commit();
    if (!no_map.empty()) throw std::runtime_error(no_map);
    if (!failure.empty())
        throw std::runtime_error(settings.input + ": " + failure + " (see " +
                                 (fs::path(settings.output_dir) / "frames.csv").string() + ")");
    for (const std::string& name : kResults)  // what else had such a name is removed
        if (fs::exists(fs::path(settings.output_dir) / name)) report.files.push_back(name);
    for (const std::string& file :
         {settings.covariances, settings.map_out, settings.simple_map, settings.rawlog_with_poses})
        if (!file.empty())  // not in the output folder
            report.files.push_back((fs::path(file).is_absolute() ? "" : "./") + file);
    return report;
}

}  // namespace roevo
