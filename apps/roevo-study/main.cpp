// roevo-study: the paper's experiments on any recording; tables and plots out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <opencv2/core/utility.hpp>

#include "index.h"
#include "inputs.h"
#include "programs/option_arguments.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "roevo-compare/machine_info.h"
#include "study.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-study";

constexpr char kFooter[] =
    "Examples:\n"
    "  roevo-study --experiment canny --input office.rawlog --output out\n"
    "  roevo-study --experiment all --input rgbd_dataset_freiburg1_desk rgbd_dataset_freiburg2_desk --output "
    "out --first 300\n"
    "Experiments (name: what is varied; what is measured; files):\n"
    "  canny          the threshold of edge detection, 0.5 to 8 times Otsu's; error of the trajectory; "
    "canny.*\n"
    "  depth-weight   how far points are trusted, w_s(d) of the paper's Eq. (20); curves, error of the "
    "trajectory;\n"
    "                 depth_weight*.*\n"
    "  ablation       points that coarse tracking aligns: as DSO selects them, raw Canny pixels, organized "
    "edges\n"
    "                 without and with patches that turn with the camera; relative pose error; ablation.*\n"
    "  repeatability  ways to find features again: optical flow of corners, nearest neighbour, normals, "
    "disjoint set;\n"
    "                 share rightly found under growing change of viewpoint; repeatability*.*\n"
    "  efficiency     registration by organized edges or by a distance field; processor time per stage;\n"
    "                 efficiency*.*\n"
    "  all            all of these, which are the paper's\n"
    "  loop           whether loops are closed; error between start and end of paths that return; loop.*\n"
    "  sigmas         nothing; squared errors of the motion over 1 s, 3 s and from the start against\n"
    "                 what its covariance says; sigmas*.*\n"
    "  distribution   nothing; error of the trajectory (median, least, largest), final against live,\n"
    "                 what the map refused; distribution*.*\n"
    "  gaps           20, 60 and 120 frames cut out (--gap) at ten places; whether the camera is found "
    "again,\n"
    "                 error of the other frames against the uncut run's; gaps.*\n"
    "  growth         the size of the images, 0.5 to 3 times, over the first 150 frames; number of edges, "
    "length;\n"
    "                 processor time per frame, memory; growth*.*\n"
    "loop, sigmas and distribution run in ba and in tr unless --mode says, and the last two forwards and\n"
    "backwards, from five starts each (0, 3, 6, 9 and 12 frames left out).\n"
    "Each writes CSV tables and SVG plots into the output folder; study.md there explains and lists them.\n"
    "A recording that cannot be used is named, and the others go on. All but repeatability, efficiency and\n"
    "growth need ground truth for errors. Run on an idle machine for efficiency and growth. Exit code 1 when "
    "an experiment\n"
    "could use no recording or a plot is missing.";

struct Study {
    const char *name, *title;
    Experiment run;
    bool of_paper = true;  // part of "all"
};
constexpr Study kStudies[] = {
    {"canny", "Canny threshold", studyCannyThreshold},
    {"depth-weight", "Depth weight", studyDepthWeight},
    {"ablation", "Ablation of coarse tracking", studyAblation},
    {"repeatability", "Repeatability", studyRepeatability},
    {"efficiency", "Efficiency", studyEfficiency},
    {"sigmas", "Sigmas", studySigmas, false},
    {"distribution", "Distribution of errors", studyDistribution, false},
    {"loop", "Paths that return", studyLoop, false},
    {"gaps", "Gaps in a recording", studyGaps, false},
    {"growth", "Growth of time and memory", studyGrowth, false},
};

// What is wrong with the name of an experiment; empty when nothing is.
std::string faultOfName(const std::string& name) {
    std::string known;
    for (const Study& study : kStudies) {
        if (name == study.name) return "";
        known += std::string(study.name) + ", ";
    }
    return name == "all" ? "" : "there is no '" + name + "'; known are " + known + "all";
}

std::vector<Study> chosenStudies(const std::vector<std::string>& names) {
    std::vector<Study> chosen;
    for (const Study& study : kStudies)
        if (std::any_of(names.begin(), names.end(), [&](const std::string& name) {
                return name == study.name || (name == "all" && study.of_paper);
            }))
            chosen.push_back(study);
    return chosen;
}

// Runs all of them: one that fails leaves the others be.
int runStudies(const std::vector<Study>& studies, const std::vector<StudyInput>& inputs,
               const std::string& folder, StudyIndex index) {
    std::string plot_fault, failure;
    for (const Study& study : studies) {
        IndexEntry entry;
        entry.title = study.title;
        try {
            entry.report = study.run(inputs, folder);
            std::printf("%-14s %s\n%s", study.name, entry.report.summary.c_str(), entry.report.table.c_str());
            for (const LeftOut& left_out : entry.report.left_out)
                std::printf("%-14s %s: left out: %s\n", "", left_out.name.c_str(), left_out.reason.c_str());
            for (const std::string& note : entry.report.notes) std::printf("%-14s %s\n", "", note.c_str());
            if (plot_fault.empty()) plot_fault = entry.report.plot_fault;
        } catch (const std::exception& e) {
            entry.failure = firstLine(e.what());
            std::printf("%-14s failed: %s\n", study.name, entry.failure.c_str());
            if (failure.empty()) failure = std::string(study.name) + ": " + entry.failure;
        }
        std::fflush(stdout);
        index.entries.push_back(std::move(entry));
        writeIndex(folder, inputs, index);
    }
    for (const std::string& line : damageLines(inputs)) std::printf("%-14s %s\n", "damaged", line.c_str());
    std::fflush(stdout);
    if (!failure.empty()) throw std::runtime_error(failure);
    if (!plot_fault.empty()) throw std::runtime_error(plot_fault + "; the tables are in " + folder);
    return 0;
}

// @throws UsageError
void checkUsage(const InputSettings& settings) {
    if (!settings.choice.ground_truth.empty() && settings.paths.size() > 1)
        throw UsageError("--ground-truth is for a single --input, and there are " +
                         std::to_string(settings.paths.size()));
    if (!settings.choice.ground_truth.empty() && settings.ignore_ground_truth)
        throw UsageError("--ground-truth and --no-ground-truth exclude each other");
    if (settings.first > 0 && settings.first < kFewestFrames)
        throw UsageError("--first " + std::to_string(settings.first) + ": a study needs at least " +
                         std::to_string(kFewestFrames) + " frames");
}

int run(int argc, char** argv) {
    InputSettings settings;
    std::string output, config_file, mode;
    std::vector<std::string> experiments, sets;
    std::vector<double> truth_sigma{0, 0};
    CLI::App app(
        "The experiments of the ROEVO paper (Liu et al.) on your own recordings: tables (CSV) and plots "
        "(SVG).",
        kName);
    app.add_option("--experiment", experiments,
                   "canny, depth-weight, ablation, repeatability, efficiency or all; loop, sigmas, "
                   "distribution, gaps, growth; one or more, see below")
        ->required()
        ->delimiter(',')
        ->check(faultOfName, "");
    app.add_option("--input", settings.paths, "Recordings: .rawlog files, ROS bags or dataset folders")
        ->required();
    app.add_option("--output", output, "Folder for the results; created when missing")->required();
    app.add_option("--config", config_file, "Options (.ini), see config_ini/roevo.ini");
    addSetOption(app, sets);
    app.add_option("--mode", mode,
                   "Of the odometry, where the experiment does not choose it: ct, tr or ba (default; "
                   "loop, sigmas and distribution: ba and tr)");
    app.add_flag(
        "--no-ground-truth", settings.ignore_ground_truth,
        "Do without, even where some is beside a recording: repeatability is then judged by the odometry's "
        "own poses");
    app.add_option("--truth-sigma", truth_sigma,
                   "sigmas: what positions (m) and orientations (degrees) of the ground truth err by, "
                   "one sigma per axis (default: 0 0, exact)")
        ->expected(2)
        ->check(faultOfNumber, "")
        ->type_name("M DEG");
    app.add_option("--gap", settings.gaps, "gaps: how many frames are cut out, one or more numbers")
        ->check([](const std::string& word) { return faultOfCount(word, 1); }, "")
        ->capture_default_str();
    addFrameOptions(app, settings.first, settings.skip, " of each recording");
    addInputOptions(app, settings.choice);
    app.footer(kFooter);
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    std::vector<std::string> words(argv, argv + argc);
    words.front() = kName;
    const std::vector<Study> studies = chosenStudies(experiments);
    settings.truth_noise = {truth_sigma[0], truth_sigma[1] * kDegree};
    checkUsage(settings);
    settings.options = collectOptions(config_file, sets, mode);
    if (!mode.empty()) settings.modes = {settings.options.mode};
    cv::setNumThreads(1);  // times are of one core
    const std::string time = utcNow();
    const OpenedInputs inputs = openInputs(settings);
    StudyIndex index{shellCommand(words), time, inputs.left_out, {}};
    prepareOutputFolder(output);
    for (const LeftOut& left_out : inputs.left_out)
        std::printf("%-14s %s: %s\n", "not used", left_out.name.c_str(), left_out.reason.c_str());
    return runStudies(studies, inputs.usable, output, std::move(index));
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
