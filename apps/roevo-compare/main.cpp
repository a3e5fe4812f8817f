// roevo-compare: our odometry and others over the same recordings, each run in a process of its own; a table
// and a report of errors, times and memory out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "compare.h"
#include "evaluation/trajectory_io.h"
#include "given_trajectory.h"
#include "machine_info.h"
#include "programs/option_arguments.h"
#include "programs/program.h"
#include "run_child.h"
#include "terminal_table.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-compare";
constexpr double kTimeout = 7200;  // s
constexpr char kForBatch[] = "For programs that start this one, as roevo-batch does";

constexpr char kFooter[] =
    "Examples:\n"
    "  roevo-compare --input office.rawlog --output comparison\n"
    "  roevo-compare --input rgbd_dataset_freiburg1_xyz --methods roevo-ba,roevo-tr --output comparison\n"
    "  roevo-compare --input office --trajectory ORB-SLAM3=orb.txt RTAB-Map=rtab.txt --output comparison\n"
    "  roevo-compare --report batch/runs --baseline last_week/runs --output report\n"
    "Many recordings at once, on all cores or a cluster: roevo-batch.\n"
    "Written into the output folder: table.csv, table.md, report.html, config_used.ini, and in\n"
    "runs/SEQUENCE/METHOD/ what each method made of each recording: trajectory.txt (TUM format),\n"
    "frames.csv, map.3Dscene for methods with a map, and its row, run.json.";

struct Arguments {
    std::vector<std::string> inputs, methods, sets, report, baseline, trajectories;
    std::string output, config, name, note, variant, key, command;
    InputChoice choice;
    std::size_t first = 0, skip = 0;
    double timeout = kTimeout, memory = 0;
    std::optional<double> paper_ate;
    bool rows_only = false, list_methods = false, quiet = false;
    std::string run_method, run_folder;  // of a child
};

void addOptions(CLI::App& app, Arguments& a) {
    app.add_option("--input", a.inputs, "Rawlogs, ROS bags or dataset folders, one or more");
    app.add_option("--methods", a.methods, "Names, separated by commas (default: all)")->delimiter(',');
    app.add_option(
        "--trajectory", a.trajectories,
        "NAME=FILE: poses that other programs made of a single --input, to stand beside the methods, "
        "without times; TUM, EuRoC or KITTI (with a row for each of the ground truth's)");
    app.add_flag("--list-methods", a.list_methods, "Say what methods there are and end");
    app.add_option("--output", a.output, "Folder for the results; created when missing");
    app.add_option("--config", a.config, "Options of ROEVO (.ini), see config_ini/roevo.ini");
    addSetOption(app, a.sets);
    addFrameOptions(app, a.first, a.skip, " of each recording");
    addInputOptions(app, a.choice);
    app.add_option("--timeout", a.timeout, "Seconds after which a run is ended as a failure")
        ->capture_default_str();
    app.add_option("--memory", a.memory,
                   "MB that a run may have before it is ended as a failure (0: no limit)")
        ->capture_default_str()
        ->check(faultOfNumber, "");
    app.add_option("--report", a.report,
                   "Make no run, but the report of rows: folders with run.json files anywhere below them, or "
                   "such files");
    app.add_option("--baseline", a.baseline, "With --report: rows of an earlier comparison, to compare with");
    app.add_flag("--rows-only", a.rows_only,
                 "Make the runs and their rows, but no report; several programs may do so in one folder, as "
                 "roevo-batch has them")
        ->group(kForBatch);
    app.add_option("--name", a.name, "Name of a single --input in tables (default: that of its file)");
    app.add_option("--note", a.note, "What a reader must know of a single --input")->group(kForBatch);
    app.add_option("--paper-ate", a.paper_ate, "ATE of ROEVO-TR+BA on a single --input in the paper, cm")
        ->group(kForBatch);
    app.add_option("--variant", a.variant, "Name of this configuration, behind the methods' names in tables")
        ->group(kForBatch);
    app.add_option("--key", a.key, "Kept in each row: by it roevo-batch tells what a row was made of")
        ->group(kForBatch);
    app.add_option("--command", a.command,
                   "With --report: the command that it shows as its own (default: this)")
        ->group(kForBatch);
    app.add_flag("--quiet", a.quiet, "Print errors only");
    app.add_option("--run-method", a.run_method)->group("");  // how this program starts itself for a run
    app.add_option("--run-folder", a.run_folder)->group("");
    app.footer(kFooter);
}

void listMethods() {
    for (const MethodInfo& method : knownMethods()) {
        std::printf("%-20s %s: %s\n", method.name.c_str(), method.label.c_str(), method.note.c_str());
        if (!method.unavailable.empty())
            std::printf("%-20s not available here: %s\n", "", method.unavailable.c_str());
    }
}

std::vector<MethodInfo> chosenMethods(const std::vector<std::string>& names) {
    const std::vector<MethodInfo> all = knownMethods();
    if (names.empty()) return all;
    std::vector<MethodInfo> chosen;
    for (const std::string& name : names) {
        const auto is = [&](const MethodInfo& m) { return m.name == name; };
        const auto found = std::find_if(all.begin(), all.end(), is);
        if (found == all.end()) {
            std::string known;
            for (const MethodInfo& m : all) known += (known.empty() ? "" : ", ") + m.name;
            throw UsageError("--methods: there is no '" + name + "'; there are " + known);
        }
        if (std::any_of(chosen.begin(), chosen.end(), is))
            throw UsageError("--methods: '" + name + "' is there twice");
        chosen.push_back(*found);
    }
    return chosen;
}

void checkSets(const Arguments& a) {
    for (const std::string& set : a.sets)
        if (set.rfind("odometry.mode=", 0) == 0)
            throw UsageError("--set: the mode is each method's own; choose by --methods");
}

void checkUsage(const Arguments& a) {
    if (a.inputs.empty() && a.report.empty()) throw UsageError("--input or --report is required");
    if (!a.inputs.empty() && !a.report.empty()) throw UsageError("--input and --report exclude each other");
    if (!a.baseline.empty() && a.report.empty()) throw UsageError("--baseline is for --report");
    if (a.output.empty()) throw UsageError("--output is required");
    const std::pair<const char*, bool> of_one[] = {{"--ground-truth", !a.choice.ground_truth.empty()},
                                                   {"--name", !a.name.empty()},
                                                   {"--note", !a.note.empty()},
                                                   {"--trajectory", !a.trajectories.empty()},
                                                   {"--paper-ate", a.paper_ate.has_value()}};
    for (const auto& [option, is_given] : of_one)
        if (is_given && a.inputs.size() != 1)
            throw UsageError(std::string(option) + " is for a single --input");
    if (!isNameOfAFolder(a.name)) throw UsageError("--name " + a.name + ": it cannot be that of a folder");
    if (!isNameOfAFolder(a.variant))
        throw UsageError("--variant " + a.variant + ": it cannot be part of a folder's name");
    if (!(a.timeout > 0)) throw UsageError("--timeout must be more than 0 s");
    checkSets(a);
}

std::vector<SequenceInput> inputSequences(const Arguments& a) {
    std::vector<SequenceInput> sequences;
    const std::vector<std::string> names = sequenceNames(a.inputs);
    for (std::size_t i = 0; i < a.inputs.size(); ++i) {
        std::error_code ignored;
        // With --rows-only that is for a row to say
        if (!a.rows_only && a.run_method.empty() && !std::filesystem::exists(a.inputs[i], ignored))
            throw std::runtime_error("cannot read " + a.inputs[i] + ": there is no such file or folder");
        SequenceInput sequence;
        sequence.name = a.name.empty() ? names[i] : a.name;
        sequence.input = a.inputs[i];
        sequence.choice = a.choice;
        sequence.skip = a.skip;
        sequence.first = a.first;
        sequence.note = a.note;
        sequence.paper_ate_cm = a.paper_ate;
        sequences.push_back(sequence);
    }
    return sequences;
}

void print(const ComparisonReport& report, const Arguments& a) {
    if (a.quiet) return;
    if (report.sequences.size() <= kManySequences)
        std::printf("%s\n", terminalTable(report.sequences).c_str());
    for (const std::string& note : report.info.notes) std::printf("%s\n", note.c_str());
    std::printf("files       %s\n", (std::filesystem::path(a.output) / "").c_str());
}

// What makes the whole a failure although the report is written.
std::string failureOf(const ComparisonReport& report, const Arguments& a) {
    std::string failure, no_evaluation;
    bool some_good = false, some_evaluated = false;
    for (const SequenceComparison& sequence : report.sequences) {
        const auto evaluated = evaluateRuns(sequence);
        for (std::size_t i = 0; i < sequence.runs.size(); ++i) {
            const MethodRun& run = sequence.runs[i];
            some_good = some_good || run.ok();
            some_evaluated = some_evaluated || evaluated[i].evaluation;
            if (failure.empty()) failure = run.failure.empty() ? run.skipped : run.failure;
            if (run.ok() && no_evaluation.empty()) no_evaluation = evaluated[i].fault;
        }
    }
    if (!some_good) return "no method gave a result; the first: " + failure;
    if (!a.choice.ground_truth.empty() && !some_evaluated)
        return a.choice.ground_truth + ": " + no_evaluation;
    return {};
}

int runAsChild(const Arguments& a) {
    if (a.inputs.size() != 1 || a.run_folder.empty())
        throw UsageError(
            "--run-method is for runs that this program starts by itself: it takes one --input "
            "and --run-folder; use --methods");
    ChildSettings child;
    child.method = a.run_method;
    if (!a.trajectories.empty()) child.trajectory = splitNamedFile(a.trajectories.front()).file;
    child.folder = a.run_folder;
    child.sequence = inputSequences(a).front();
    child.memory_mb = a.memory;
    child.options = collectOptions(a.config, a.sets, "");
    runChild(child);
    return 0;
}

// The options for all methods. The mode is none of them: each of ROEVO's methods is a mode.
OdometryOptions methodOptions(const Arguments& a) {
    OdometryOptions options = collectOptions(a.config, a.sets, "");
    const Mode own = OdometryOptions().mode;
    if (options.mode != own && !a.quiet)
        printWarning(kName, std::string("mode = ") + toString(options.mode) + " in " + a.config +
                                " has no effect here: each method has its own, choose by --methods");
    options.mode = own;
    return options;
}

int run(int argc, char** argv) {
    Arguments a;
    CLI::App app("Compares odometries on the same recordings: errors, times, memory.", kName);
    addOptions(app, a);
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    if (!a.run_method.empty()) return runAsChild(a);
    if (a.list_methods) {
        checkSets(a);
        collectOptions(a.config, a.sets, "");  // so that roevo-batch knows before its first job
        listMethods();
        return 0;
    }
    checkUsage(a);

    const std::string command = a.command.empty() ? shellCommand({argv, argv + argc}) : a.command;
    if (!a.report.empty()) {
        print(reportRows(a.report, a.baseline, a.output, command), a);
        return 0;
    }
    CompareSettings settings;
    settings.methods = chosenMethods(a.methods);
    if (!a.variant.empty())
        for (MethodInfo& method : settings.methods) {
            method.name += kVariantMark + a.variant;
            method.label += " (" + a.variant + ")";
        }
    for (MethodInfo& given : givenTrajectories(a.trajectories)) settings.methods.push_back(std::move(given));
    settings.sequences = inputSequences(a);
    settings.timeout_s = a.timeout;
    settings.memory_mb = a.memory;
    settings.options = methodOptions(a);
    settings.output = a.output;
    settings.key = a.key;
    settings.quiet = a.quiet;
    settings.command = command;
    if (a.rows_only) {
        makeRows(settings);
        return 0;
    }
    const ComparisonReport report = compare(settings);
    print(report, a);
    if (const std::string failure = failureOf(report, a); !failure.empty()) throw std::runtime_error(failure);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
