// roevo-odometry: a rawlog, a bag or an RGB-D dataset folder in; a trajectory, a map and a report on every
// frame out.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <opencv2/core/utility.hpp>

#include "programs/atomic_file.h"
#include "programs/option_arguments.h"
#include "programs/program.h"
#include "roevo_mrpt/config_file.h"
#include "run.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-odometry";

constexpr char kFooter[] =
    "Examples:\n"
    "  roevo-odometry --input office.rawlog --output out\n"
    "  roevo-odometry --input rgbd_dataset_freiburg1_xyz --output out --set keyframe.max_rotation_deg=10\n"
    "Written into the output folder: trajectory.txt, trajectory_live.txt, keyframes.txt (TUM format), "
    "frames.csv,\n"
    "map.3Dscene, map.ply, map_semi_dense.ply, summary.json, config_used.ini; trajectory_truth.txt when "
    "there is one;\n"
    "trajectory_robot.txt when a rawlog says where the camera is mounted on the robot.";

void writeDefaultConfig(const std::string& path) {
    const std::string text = toConfigText(OdometryOptions());
    if (path == "-")
        std::fputs(text.c_str(), stdout);
    else
        writeTextAtomically(path, text);
}

int run(int argc, char** argv) {
    RunSettings settings;
    settings.command.assign(argv, argv + argc);
    std::string mode, default_config;
    std::vector<std::string> sets;
    CLI::App app("RGB-D visual odometry from organized edges.", kName);
    app.add_option("--input", settings.input,
                   "A .rawlog file, a ROS bag or a dataset folder (layout detected)");
    app.add_option("--output", settings.output_dir, "Folder for the results; created when missing");
    app.add_option("--config", settings.config, "Options (.ini), see config_ini/roevo.ini");
    addSetOption(app, sets);
    app.add_option("--mode", mode,
                   "ct: coarse tracking only; tr: coarse and fine; ba: with local mapping (default)");
    app.add_option("--covariances", settings.covariances,
                   "Write the 6x6 covariance of every pose to this file, too")
        ->type_name("FILE");
    addFrameOptions(app, settings.first, settings.skip);
    addInputOptions(app, settings.choice);
    app.add_option(
        "--map-in", settings.map_in,
        "Begin with this map of an earlier recording (--map-out): poses are in its world from where "
        "the camera is recognised in it");
    app.add_option(
        "--map-out", settings.map_out,
        "Write the keyframes as a map for --map-in; with --map-in: what was there and what was added");
    app.add_flag("--localise-only", settings.localise_only, "The map of --map-in stays as it is");
    app.add_option("--simplemap", settings.simple_map,
                   "Write the keyframes, with their edges, as MRPT's CSimpleMap to this file (.simplemap)")
        ->type_name("FILE");
    app.add_flag("--simplemap-images", settings.simple_map_images,
                 "With the keyframes' colour and depth images");
    app.add_option(
           "--rawlog-with-poses", settings.rawlog_with_poses,
           "Copy the rawlog to this file, with the robot's pose and motion at every scan that has one")
        ->type_name("FILE");
    app.add_flag("--realtime", settings.realtime,
                 "Frames arrive by the clock and are dropped when tracking is behind; the tracker takes what "
                 "mapping has ready (results differ from run to run)");
    int threads = 0;
    const CLI::Option* threads_given =
        app.add_option("--threads", threads,
                       "Threads that decode, find edges and track at the same time (default: one per "
                       "processor; 1: all in one, mapping too); results are the same")
            ->check(CLI::Range(1, 256));
    bool profile = false;
    app.add_flag("--profile", profile,
                 "Print the time of each stage of a frame, ms, and relative to decoding");
    app.add_flag("--quiet", settings.quiet, "Print errors and warnings only");
    app.add_option("--write-default-config", default_config,
                   "Write all options with their defaults to this file ('-': print) and end");
    app.footer(kFooter);
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    if (!default_config.empty()) {
        writeDefaultConfig(default_config);
        return 0;
    }
    if (settings.input.empty()) throw UsageError("--input is required");
    if (settings.output_dir.empty()) throw UsageError("--output is required");
    if (settings.localise_only && settings.map_in.empty()) throw UsageError("--localise-only needs --map-in");
    if (settings.localise_only && !settings.map_out.empty())
        throw UsageError("--localise-only leaves the map as it is: there is nothing to write by --map-out");
    if (settings.simple_map_images && settings.simple_map.empty())
        throw UsageError("--simplemap-images needs --simplemap");
    settings.options = collectOptions(settings.config, sets, mode);
    if (threads_given->count() > 0) settings.options.threads = threads;
    if (!settings.options.loss.recognise && !(settings.map_in + settings.map_out).empty())
        throw UsageError("maps need loss.recognise=true: without, no places are remembered or looked for");
    if (settings.realtime) settings.options.mapping.deterministic = false;

    cv::setNumThreads(
        1);  // decoding runs beside tracking already; more threads would blur the times per frame
    const RunReport report = runOdometry(settings);
    for (const std::string& warning : {report.warning, report.rejectionWarning(), report.cameraWarning(),
                                       report.evaluationWarning(), report.scale_warning, report.mapWarning()})
        if (!warning.empty()) printWarning(kName, warning);
    if (!settings.quiet) printSummary(report, settings.output_dir);
    if (profile) printProfile(report);
    if (!report.evaluation && !settings.choice.ground_truth.empty())
        throw std::runtime_error(settings.choice.ground_truth + ": " + report.evaluation_fault);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
