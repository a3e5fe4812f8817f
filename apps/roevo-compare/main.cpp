// roevo-compare: our odometry and others over the same recordings, each run in a process of its own; a table
// and a report of errors, times and memory out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "benchmark_list.h"
#include "compare.h"
#include "machine_info.h"
#include "programs/option_arguments.h"
#include "programs/program.h"
#include "run_child.h"
#include "terminal_table.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-compare";
constexpr double kTimeout = 7200;  // s

constexpr char kFooter[] =
    "Examples:\n"
    "  roevo-compare --input office.rawlog --output comparison\n"
    "  roevo-compare --input rgbd_dataset_freiburg1_xyz --methods roevo-ba,roevo-tr --output comparison\n"
    "  roevo-compare --benchmark datasets_readme/sequences.json --data data --output benchmark --jobs 2\n"
    "Written into the output folder: table.csv, table.md, report.html, config_used.ini, and in\n"
    "runs/SEQUENCE/METHOD/ what each method made of each recording: trajectory.txt (TUM format),\n"
    "frames.csv, map.3Dscene for methods with a map, run.json.";

struct Arguments {
    std::vector<std::string> inputs, methods, sets;
    std::string benchmark, data, ground_truth, output, config;
    InputChoice choice;
    std::size_t first = 0, skip = 0, jobs = 1;
    double timeout = kTimeout;
    bool resume = false, list_methods = false, quiet = false;
    std::string run_method, run_folder;  // of a child
};

void addOptions(CLI::App& app, Arguments& a) {
    app.add_option("--input", a.inputs, "Rawlogs, ROS bags or dataset folders, one or more");
    app.add_option("--ground-truth", a.ground_truth,
                   "TUM trajectory to compare with, for a single --input (default: what lies beside each)");
    app.add_option("--benchmark", a.benchmark,
                   "List of sequences (as datasets_readme/sequences.json) to run instead, those that are on "
                   "disk; always with --resume, so that the same command goes on after an interrupt");
    app.add_option("--data", a.data, "Folder below which the sequences of --benchmark lie");
    app.add_option("--methods", a.methods, "Names, separated by commas (default: all)")->delimiter(',');
    app.add_flag("--list-methods", a.list_methods, "Say what methods there are and end");
    app.add_option("--output", a.output, "Folder for the results; created when missing");
    app.add_option("--config", a.config, "Options of ROEVO (.ini), see config_ini/roevo.ini");
    app.add_option("--set", a.sets, "section.key=value: one option on top of the config; may be repeated")
        ->allow_extra_args(false);
    app.add_option("--first", a.first, "Process at most this many frames of each recording")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--skip", a.skip, "Leave out this many frames at the start of each recording")
        ->check(CLI::NonNegativeNumber);
    addInputOptions(app, a.choice);
    app.add_option("--timeout", a.timeout, "Seconds after which a run is ended as a failure")
        ->capture_default_str();
    app.add_flag("--resume", a.resume,
                 "Keep the runs in the output folder that were made with the same settings, a method's own "
                 "failures, too; made anew are those that were killed from outside (signals 1, 2, 9, 15) and "
                 "those whose core other programs had for more than 5 % of the time");
    app.add_option("--jobs", a.jobs,
                   "This many runs side by side, each on a core of its own (times are noisier then)")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
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

// One core for each job, the last ones: the first is often the busiest with the system's own work.
std::vector<int> chosenCores(std::size_t jobs) {
    std::vector<int> cores = allowedCores();
    if (cores.empty()) cores = {-1};  // the system does not tell
    if (jobs > cores.size())
        throw UsageError("--jobs " + std::to_string(jobs) + ": each takes a core of its own, and there " +
                         (cores.size() == 1 ? "is 1" : "are " + std::to_string(cores.size())));
    return {cores.end() - static_cast<std::ptrdiff_t>(jobs), cores.end()};
}

void checkUsage(const Arguments& a) {
    if (a.inputs.empty() && a.benchmark.empty()) throw UsageError("--input or --benchmark is required");
    if (!a.inputs.empty() && !a.benchmark.empty())
        throw UsageError("--input and --benchmark exclude each other");
    if (a.benchmark.empty() != a.data.empty()) throw UsageError("--benchmark and --data go together");
    if (a.output.empty()) throw UsageError("--output is required");
    if (!a.ground_truth.empty() && a.inputs.size() != 1)
        throw UsageError("--ground-truth is for a single --input");
    if (!(a.timeout > 0)) throw UsageError("--timeout must be more than 0 s");
    for (const std::string& set : a.sets)
        if (set.rfind("odometry.mode=", 0) == 0)
            throw UsageError("--set: the mode is each method's own; choose by --methods");
}

std::vector<SequenceInput> inputSequences(const Arguments& a) {
    std::vector<SequenceInput> sequences;
    const std::vector<std::string> names = sequenceNames(a.inputs);
    for (std::size_t i = 0; i < a.inputs.size(); ++i) {
        std::error_code ignored;
        if (!std::filesystem::exists(a.inputs[i], ignored))
            throw std::runtime_error("cannot read " + a.inputs[i] + ": there is no such file or folder");
        SequenceInput sequence;
        sequence.name = names[i];
        sequence.input = a.inputs[i];
        sequence.ground_truth = a.ground_truth;
        sequences.push_back(sequence);
    }
    return sequences;
}

// --skip and --first count within what a list leaves of a sequence.
void restrictFrames(std::vector<SequenceInput>& sequences, const Arguments& a) {
    for (SequenceInput& sequence : sequences) {
        if (sequence.first > 0 && a.skip >= sequence.first)
            throw UsageError("--skip " + std::to_string(a.skip) + " leaves nothing of " + sequence.name +
                             ", of which the list takes " + std::to_string(sequence.first) + " frames");
        if (sequence.first > 0) sequence.first -= a.skip;
        sequence.skip += a.skip;
        if (a.first > 0) sequence.first = sequence.first > 0 ? std::min(sequence.first, a.first) : a.first;
        if (a.first > 0 || a.skip > 0) sequence.paper_ate_cm.reset();  // it is of all frames
        sequence.choice = a.choice;
    }
}

void report(const CompareResult& result, const CompareSettings& settings) {
    if (settings.quiet) return;
    std::printf("%s\n", terminalTable(result.sequences).c_str());
    for (const std::string& note : result.info.notes) std::printf("%s\n", note.c_str());
    std::printf("files       %s\n", (std::filesystem::path(settings.output) / "").c_str());
}

// What makes the whole a failure although the report is written.
std::string failureOf(const CompareResult& result, const Arguments& a, const CompareSettings& settings) {
    if (result.interrupted)
        return "interrupted: " + std::to_string(result.left) + (result.left == 1 ? " run is" : " runs are") +
               " still to be made; the same command" + (settings.resume ? "" : " with --resume") + " goes on";
    std::string failure, no_evaluation;
    bool some_good = false, some_evaluated = false;
    for (const SequenceComparison& sequence : result.sequences) {
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
    if (!a.ground_truth.empty() && !some_evaluated) return a.ground_truth + ": " + no_evaluation;
    return {};
}

int runAsChild(const Arguments& a) {
    if (a.inputs.size() != 1 || a.run_folder.empty())
        throw UsageError(
            "--run-method is for runs that this program starts by itself: it takes one --input "
            "and --run-folder; use --methods");
    ChildSettings child;
    child.method = a.run_method;
    child.folder = a.run_folder;
    child.input = a.inputs.front();
    child.choice = a.choice;
    child.skip = a.skip;
    child.first = a.first;
    child.options = collectOptions(a.config, a.sets, "");
    runChild(child);
    return 0;
}

// The options for all methods. The mode is none of them: each of ROEVO's methods is a mode.
OdometryOptions methodOptions(const Arguments& a) {
    OdometryOptions options = collectOptions(a.config, a.sets, "");
    const Mode own = OdometryOptions().mode;
    if (options.mode != own && !a.quiet)
        std::fprintf(stderr,
                     "warning: mode = %s in %s has no effect here: each method has its own, choose by "
                     "--methods\n",
                     toString(options.mode), a.config.c_str());
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
        listMethods();
        return 0;
    }
    checkUsage(a);

    CompareSettings settings;
    settings.methods = chosenMethods(a.methods);
    settings.queue = {chosenCores(a.jobs), a.timeout};
    settings.options = methodOptions(a);
    settings.output = a.output;
    settings.resume = a.resume || !a.benchmark.empty();
    settings.quiet = a.quiet;
    settings.command = shellCommand({argv, argv + argc});
    if (a.benchmark.empty()) {
        settings.sequences = inputSequences(a);
    } else {
        BenchmarkList list = readBenchmarkList(a.benchmark, a.data);
        settings.sequences = std::move(list.sequences);
        settings.missing = std::move(list.missing);
        for (const std::string& missing : settings.missing)
            if (!a.quiet) std::fprintf(stderr, "skipped %s\n", missing.c_str());
        if (settings.sequences.empty())
            throw std::runtime_error("not one sequence of " + a.benchmark + " is in " + a.data + "; e.g. " +
                                     settings.missing.front());
    }
    restrictFrames(settings.sequences, a);

    const CompareResult result = compare(settings);
    report(result, settings);
    if (const std::string failure = failureOf(result, a, settings); !failure.empty())
        throw std::runtime_error(failure);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
