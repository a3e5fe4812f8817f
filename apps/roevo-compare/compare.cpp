#include "compare.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "machine_info.h"
#include "queue_display.h"
#include "report/text.h"
#include "roevo_mrpt/config_file.h"
#include "support/interrupt.h"
#include "support/output_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kDisturbed = 0.05;  // share of a run without the core from which on its times are in doubt
constexpr char kConfigFile[] = "config_used.ini";

std::string inOutput(const CompareSettings& settings, const fs::path& name) {
    return (fs::path(settings.output) / name).string();
}

// Two programs at work in one folder would remove each other's runs.
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
        if (!opened.failure.empty())
            std::fprintf(stderr, "%s: cannot be used: %s\n", opened.name.c_str(), opened.failure.c_str());
    }
    const auto usable = [](const SequenceComparison& s) { return s.failure.empty(); };
    if (std::any_of(all.begin(), all.end(), usable)) return all;
    const SequenceComparison& first = all.front();
    const bool named = first.failure.find(first.input) != std::string::npos;
    throw std::runtime_error((named ? "" : first.input + ": ") + first.failure +
                             (all.size() > 1 ? " (and no other recording can be used)" : ""));
}

// All that a run depends on but the method itself.
std::map<std::string, std::string> runSettings(const CompareSettings& settings, const SequenceInput& sequence,
                                               const std::string& program) {
    OdometryOptions options = settings.options;
    options.mode = OdometryOptions().mode;  // each method has its own
    std::string values, versions;
    for (const OptionField& field : optionFields(options))
        values += field.name() + "=" + field.toText() + "; ";
    for (const auto& [name, version] : softwareVersions()) versions += name + " " + version + "; ";
    std::map<std::string, std::string> all{{"recording", recordingState(sequence.input)},
                                           {"sensor_label", sequence.sensor_label},
                                           {"skip", std::to_string(sequence.skip)},
                                           {"first", std::to_string(sequence.first)},
                                           {"options", values},
                                           {"program", program},
                                           {"versions", versions},
                                           {"processor", processorName()}};
    for (auto& [key, value] : all) value = cleanText(value);  // as it comes back from the file
    return all;
}

std::vector<std::string> childCommand(const RunTask& task, const std::string& folder,
                                      const SequenceInput& sequence, const std::string& config) {
    // Not the path of this program: it may be another one by now, had it been built anew
    std::vector<std::string> command{"/proc/self/exe", "--run-method", task.method.name,
                                     "--run-folder",   folder,         "--input",
                                     sequence.input,   "--config",     config};
    const auto add = [&](const char* option, const std::string& value) {
        command.insert(command.end(), {option, value});
    };
    if (sequence.skip > 0) add("--skip", std::to_string(sequence.skip));
    if (sequence.first > 0) add("--first", std::to_string(sequence.first));
    if (!sequence.sensor_label.empty()) add("--sensor-label", sequence.sensor_label);
    return command;
}

/// The runs of a comparison, by sequence and method, as they come in.
class Runs : public QueueObserver {
  public:
    Runs(const CompareSettings& settings, std::vector<SequenceComparison>& sequences);

    /// Makes what is still to be made. @throws as runTasks()
    void make();

    void finished(std::size_t task, const MethodRun& run, double seconds) override {
        place_[where_[task].first][where_[task].second] = run;
        display_.finished(task, run, seconds);
    }
    void going(const std::map<std::size_t, double>& running) override { display_.going(running); }

    /// Puts all runs that there are into the sequences, in the order of the methods.
    void deliver();

    std::size_t count() const;
    std::size_t total() const;
    std::size_t reused() const { return reused_; }
    bool anythingToDo() const { return !tasks_.empty(); }

  private:
    void plan(std::size_t s, std::size_t m, const std::map<std::string, std::string>& run_settings);
    std::string folder(std::size_t s, std::size_t m) const {
        return inOutput(settings_, fs::path("runs") / sequences_[s].name / settings_.methods[m].name);
    }

    const CompareSettings& settings_;
    std::vector<SequenceComparison>& sequences_;
    std::vector<std::vector<std::optional<MethodRun>>> place_;
    std::vector<RunTask> tasks_;
    std::vector<std::pair<std::size_t, std::size_t>> where_;  // of each task: sequence, method
    std::size_t reused_ = 0;
    QueueDisplay display_{tasks_, !settings_.quiet};
};

Runs::Runs(const CompareSettings& settings, std::vector<SequenceComparison>& sequences)
    : settings_(settings), sequences_(sequences), place_(sequences.size()) {
    const std::string program = programState();
    for (std::size_t s = 0; s < sequences.size(); ++s) {
        if (!sequences[s].failure.empty()) continue;
        place_[s].resize(settings.methods.size());
        const auto run_settings = runSettings(settings, settings.sequences[s], program);
        for (std::size_t m = 0; m < settings.methods.size(); ++m) plan(s, m, run_settings);
    }
}

void Runs::plan(std::size_t s, std::size_t m, const std::map<std::string, std::string>& run_settings) {
    const MethodInfo& method = settings_.methods[m];
    MethodRun run;
    if (!method.unavailable.empty()) {
        run.method = method.name;
        run.label = method.label;
        run.note = method.note;
        run.input = sequences_[s].input;
        run.skipped = method.unavailable;
        place_[s][m] = run;
        return;
    }
    RunTask task{sequences_[s].name, sequences_[s].input, method, folder(s, m), run_settings};
    if (settings_.resume && findFinishedRun(task, settings_.queue.timeout_s, run)) {
        place_[s][m] = run;
        ++reused_;
        if (!run.failure.empty() && !settings_.quiet)
            std::fprintf(stderr, "%s, %s: kept as it is, FAILED: %s (remove %s to have it run again)\n",
                         task.sequence.c_str(), method.name.c_str(), run.failure.c_str(),
                         task.folder.c_str());
        return;
    }
    tasks_.push_back(std::move(task));
    where_.emplace_back(s, m);
}

void Runs::make() {
    const std::string config = inOutput(settings_, kConfigFile);
    const auto command = [&](const RunTask& task, const std::string& run_folder) {
        const std::size_t index = static_cast<std::size_t>(&task - tasks_.data());
        return childCommand(task, run_folder, settings_.sequences[where_[index].first], config);
    };
    runTasks(tasks_, command, settings_.queue, *this);
}

std::size_t Runs::count() const {
    std::size_t count = 0;
    for (const auto& runs : place_)
        for (const auto& run : runs) count += run && run->skipped.empty();
    return count;
}

std::size_t Runs::total() const {
    std::size_t total = 0;
    for (const auto& runs : place_)
        for (const auto& run : runs) total += !run || run->skipped.empty();
    return total;
}

void Runs::deliver() {
    for (std::size_t s = 0; s < sequences_.size(); ++s) {
        std::set<std::string> warnings;
        for (std::size_t m = 0; m < place_[s].size(); ++m) {
            if (!place_[s][m]) continue;
            const MethodRun& run = *place_[s][m];
            if (!run.warning.empty() && warnings.insert(run.warning).second)
                sequences_[s].note += (sequences_[s].note.empty() ? "" : "; ") + run.warning;
            sequences_[s].runs.push_back(run);
            sequences_[s].run_folders.push_back(folder(s, m));
        }
    }
}

std::vector<std::string> notesOf(const CompareSettings& settings, const CompareResult& result) {
    std::vector<std::string> notes;
    std::size_t jobs = 1, disturbed = 0;
    double most_lost = 0;
    for (const SequenceComparison& sequence : result.sequences)
        for (const MethodRun& run : sequence.runs) {
            jobs = std::max(jobs, run.jobs);
            disturbed += run.core_lost > kDisturbed;
            most_lost = std::max(most_lost, run.core_lost);
        }
    if (disturbed > 0) {
        char text[256];
        std::snprintf(text, sizeof text,
                      "The machine was busy: in %zu of %zu runs other programs had the core for more than "
                      "%.0f %% of the time (up to %.0f %%), so that times per frame are too long there; "
                      "processor times hold.",
                      disturbed, result.runs, 100 * kDisturbed, 100 * most_lost);
        notes.push_back(text);
    }
    if (jobs > 1)
        notes.push_back(
            "Up to " + std::to_string(jobs) +
            " runs went on side by side, each on a core of its own: they share memory and caches, "
            "so that times are noisier, and longer, than those of runs one after the other.");
    if (!settings.missing.empty()) {
        std::string line = std::to_string(settings.missing.size()) +
                           " sequences of the list are not on this disk and were skipped: ";
        for (const std::string& missing : settings.missing)
            line +=
                missing.substr(0, missing.find(':')) + (&missing == &settings.missing.back() ? "." : ", ");
        notes.push_back(line);
    }
    if (result.interrupted)
        notes.push_back("The comparison was interrupted: " + std::to_string(result.left) +
                        " runs are missing.");
    return notes;
}

}  // namespace

CompareResult compare(const CompareSettings& settings) {
    CompareResult result;
    std::optional<FolderLock> lock;
    {
        const InterruptGuard guard;  // gone before the report is written: a second Ctrl-C ends that
        result.sequences = openAll(settings);
        prepareOutputFolder(settings.output);
        lock.emplace(settings.output);
        saveConfigFile(inOutput(settings, kConfigFile), settings.options);

        Runs runs(settings, result.sequences);
        if (runs.reused() > 0 && !settings.quiet)
            std::fprintf(stderr, "%zu of %zu runs are there already\n", runs.reused(), runs.total());
        try {
            runs.make();
        } catch (const Interrupted&) {
            result.interrupted = true;
        }
        result.runs = runs.count();
        result.left = runs.total() - runs.count();
        runs.deliver();
    }
    if (result.interrupted && result.runs == 0)
        throw Interrupted("interrupted before any run was finished; no report was written");
    result.info = {settings.command, utcNow(), machineText(), softwareVersions(), notesOf(settings, result)};
    writeComparison(settings.output, result.sequences, result.info);
    return result;
}

}  // namespace roevo
