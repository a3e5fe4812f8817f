#include "compare.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "machine_info.h"
#include "roevo_mrpt/config_file.h"
#include "runs.h"
#include "support/interrupt.h"
#include "support/output_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kDisturbed = 0.05;  // share of a run without the core from which on its times are in doubt

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
    std::exception_ptr fault;
    {
        const InterruptGuard guard;  // gone before the report is written: a second Ctrl-C ends that
        result.sequences = openAll(settings);
        prepareOutputFolder(settings.output);
        lock.emplace(settings.output);
        const std::string config = (fs::path(settings.output) / "config_used.ini").string();
        saveConfigFile(config, settings.options);

        Runs runs(settings, result.sequences);
        if (runs.reused() > 0 && !settings.quiet)
            std::fprintf(stderr, "%zu of %zu runs are there already\n", runs.reused(), runs.total());
        try {
            runs.make(config);
        } catch (const Interrupted&) {
            result.interrupted = true;
        } catch (const std::exception&) {
            fault = std::current_exception();  // what is finished is reported first
        }
        result.runs = runs.count();
        result.left = runs.total() - runs.count();
        runs.deliver();
    }
    if (result.interrupted && result.runs == 0)
        throw Interrupted("interrupted before any run was finished; no report was written");
    result.info = {settings.command, utcNow(), machineText(), softwareVersions(), notesOf(settings, result)};
    writeComparison(settings.output, result.sequences, result.info);
    if (fault) std::rethrow_exception(fault);
    return result;
}

}  // namespace roevo
