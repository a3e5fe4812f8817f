#include "compare.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "comparison_notes.h"
#include "given_trajectory.h"
#include "machine_info.h"
#include "programs/interrupt.h"
#include "programs/output_folder.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "report/baseline.h"
#include "report/distributions.h"
#include "roevo_mrpt/config_file.h"
#include "rows.h"
#include "supervised_run.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

// Two programs at work in one folder would write over each other's reports.
class FolderLock {
  public:
    explicit FolderLock(const std::string& folder)
        : fd_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            close(fd_);
            throw std::runtime_error("another roevo-compare is writing into " + folder +
                                     "; wait for its end or take another folder");
        }
    }
    ~FolderLock() {
        if (fd_ >= 0) close(fd_);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int fd_;
};

std::vector<SequenceComparison> openAll(const CompareSettings& settings) {
    std::vector<SequenceComparison> all;
    for (const SequenceInput& sequence : settings.sequences) {
        InterruptGuard::check();
        all.push_back(openSequence(sequence));
        const SequenceComparison& opened = all.back();
        if (!opened.failure.empty() && settings.sequences.size() > 1)
            std::fprintf(stderr, "%s: cannot be used: %s\n", opened.name.c_str(), opened.failure.c_str());
    }
    const auto usable = [](const SequenceComparison& s) { return s.failure.empty(); };
    if (std::any_of(all.begin(), all.end(), usable)) return all;
    const SequenceComparison& first = all.front();
    const bool named = first.failure.find(first.input) != std::string::npos;
    throw std::runtime_error((named ? "" : first.input + ": ") + first.failure +
                             (all.size() > 1 ? " (and no other recording can be used)" : ""));
}

std::vector<std::string> childCommand(const CompareSettings& settings, const SequenceInput& sequence,
                                      const MethodInfo& method, const std::string& folder) {
    const std::string config = (fs::path(folder) / "config_used.ini").string();
    OdometryOptions options = settings.options;
    options.mode = method.mode.value_or(options.mode);
    saveConfigFile(config, options);
    // Not the path of this program: it may be another one by now, had it been built anew
    std::vector<std::string> command{"/proc/self/exe", "--run-method", method.name};
    const auto add = [&](const std::string& option, const std::string& value) {
        command.insert(command.end(), {option, value});
    };
    add("--run-folder", folder);
    add("--input", sequence.input);
    add("--name", sequence.name);
    add("--config", config);
    if (!method.trajectory.empty()) add("--trajectory", method.name + "=" + method.trajectory);
    if (sequence.skip > 0) add("--skip", std::to_string(sequence.skip));
    if (sequence.first > 0) add("--first", std::to_string(sequence.first));
    if (settings.memory_mb > 0) add("--memory", std::to_string(settings.memory_mb));
    if (!sequence.note.empty()) add("--note", sequence.note);
    if (sequence.paper_ate_cm) add("--paper-ate", std::to_string(*sequence.paper_ate_cm));
    for (const auto& [option, value] : chosenOptions(sequence.choice)) add(option, value);
    return command;
}

// A method that this build lacks.
SequenceComparison skippedRow(const RunTask& task) {
    SequenceComparison row;
    row.name = task.sequence;
    MethodRun run;
    run.method = task.method.name;
    run.label = task.method.label;
    run.note = task.method.note;
    run.input = task.input;
    run.skipped = task.method.unavailable;
    run.key = task.key;
    row.runs = {run};
    row.run_folders = {task.folder};
    return row;
}

void tell(const SequenceComparison& row, double seconds) {
    const MethodRun& run = row.runs[0];
    char what[96];
    if (run.trajectory_file.empty())
        std::snprintf(what, sizeof what, "%s, %.1f ms per frame (median), ",
                      counted(run.frames, "frame").c_str(), run.total.median);
    else
        std::snprintf(what, sizeof what, "%zu of %zu frames have a pose, ", run.tracked, run.frames);
    std::fprintf(stderr, "%s, %s: %s\n", row.name.c_str(), run.method.c_str(),
                 (run.failure.empty() ? what + durationText(seconds) : "FAILED: " + run.failure).c_str());
    std::fflush(stderr);
}

SequenceComparison makeRun(const CompareSettings& settings, const SequenceInput& sequence,
                           const MethodInfo& method) {
    const std::string folder = (fs::path(settings.output) / "runs" / sequence.name / method.name).string();
    const RunTask task{sequence.name, sequence.input, method, folder, settings.timeout_s, settings.key};
    if (!method.unavailable.empty()) return skippedRow(task);
    const auto start = std::chrono::steady_clock::now();
    const auto command = [&](const std::string& partial) {
        return childCommand(settings, sequence, method, partial);
    };
    SequenceComparison row;
    {
        Progress progress(sequence.name + ", " + method.name, 0, !settings.quiet && isatty(STDERR_FILENO));
        row = supervisedRun(task, command,
                            [&](const Advance& advance) { progress.update(advance.frames, advance.share); });
    }
    if (!settings.quiet)
        tell(row, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return row;
}

// What a program that was killed has left. For who has the lock of the folder.
void removeHalfMade(const std::string& output) {
    std::error_code none;
    for (const auto& sequence : fs::directory_iterator(fs::path(output) / "runs", none))
        for (const auto& run : fs::directory_iterator(sequence, none))
            if (run.path().extension() == ".partial") fs::remove_all(run, none);
}

/// A run that is interrupted leaves nothing, those before it do.
template <typename Runs>
void keepingRuns(const std::string& output, const Runs& runs) {
    try {
        runs();
    } catch (const Interrupted&) {
        const std::string runs_folder = (fs::path(output) / "runs").string();
        throw Interrupted("interrupted: runs that were done are kept in " + runs_folder + "; --report " +
                          runs_folder + " --output " + output + " makes a report of them");
    }
}

ComparisonReport writeReport(std::vector<SequenceComparison> sequences, const std::string& output,
                             const std::string& command, const std::vector<std::string>& notes = {},
                             const std::vector<SequenceComparison>& baseline = {}) {
    ComparisonReport report{std::move(sequences), {command, utcNow(), machineText(), softwareVersions(), {}}};
    report.info.notes = comparisonNotes(report.sequences);
    report.info.notes.insert(report.info.notes.end(), notes.begin(), notes.end());
    try {
        writeComparison(output, report.sequences, report.info, baseline);
    } catch (const Interrupted&) {
        throw Interrupted(
            "interrupted while the report was being written: it was left as it was before; the "
            "runs are kept, and --report " +
            (fs::path(output) / "runs").string() + " --output " + output + " writes it");
    }
    return report;
}

}  // namespace

ComparisonReport compare(const CompareSettings& settings) {
    const InterruptGuard guard;
    std::vector<SequenceComparison> sequences = openAll(settings);
    for (const MethodInfo& method : settings.methods)  // before any run: the file may be a wrong one
        for (const SequenceComparison& sequence : sequences)
            if (!method.trajectory.empty())
                readGivenTrajectory(method.trajectory, sequence.reference, sequence.ground_truth);
    prepareOutputFolder(settings.output);
    const FolderLock lock(settings.output);
    removeHalfMade(settings.output);
    saveConfigFile((fs::path(settings.output) / "config_used.ini").string(), settings.options);
    keepingRuns(settings.output, [&] {
        for (std::size_t s = 0; s < sequences.size(); ++s)
            for (const MethodInfo& method : settings.methods) {
                if (!sequences[s].failure.empty()) continue;
                SequenceComparison row = makeRun(settings, settings.sequences[s], method);
                if (row.runs[0].ok())  // as a report of rows finds them, to the last digit
                    sequences[s].reference = row.reference;
                sequences[s].runs.push_back(std::move(row.runs[0]));
                sequences[s].run_folders.push_back(row.run_folders[0]);
            }
    });
    return writeReport(std::move(sequences), settings.output, settings.command);
}

void makeRows(const CompareSettings& settings) {
    const InterruptGuard guard;
    prepareOutputFolder(settings.output);
    keepingRuns(settings.output, [&] {
        for (const SequenceInput& sequence : settings.sequences)
            for (const MethodInfo& method : settings.methods) {
                const SequenceComparison row = makeRun(settings, sequence, method);
                if (row.runs[0].skipped.empty()) continue;  // else it is kept already
                fs::create_directories(row.run_folders[0]);
                writeRow(row.run_folders[0], row);
            }
    });
}

ComparisonReport reportRows(const std::vector<std::string>& rows, const std::vector<std::string>& baseline,
                            const std::string& output, const std::string& command) {
    const InterruptGuard guard;
    Rows read = readRows(rows);
    std::vector<SequenceComparison> earlier;
    if (!baseline.empty()) earlier = readRows(baseline).sequences;
    // Trajectories of those that have a page or a part of the page
    if (read.sequences.size() <= kManySequences)
        for (SequenceComparison& sequence : read.sequences) loadTrajectories(sequence);
    else
        for (const std::size_t s : worstRecordings(evaluateAll(read.sequences), kWorstSequences))
            loadTrajectories(read.sequences[s]);
    if (!baseline.empty())
        for (const std::string& sentence :
             changeSentences(changesSince(evaluateAll(earlier), evaluateAll(read.sequences))))
            read.notes.push_back(sentence);
    prepareOutputFolder(output);
    const FolderLock lock(output);
    ComparisonReport report = writeReport(std::move(read.sequences), output, command, read.notes, earlier);
    std::error_code ignored;  // an earlier comparison's, which the rows may not be of; each has its own
    fs::remove(fs::path(output) / "config_used.ini", ignored);
    return report;
}

}  // namespace roevo
