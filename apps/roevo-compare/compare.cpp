#include "compare.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "comparison_notes.h"
#include "machine_info.h"
#include "programs/interrupt.h"
#include "programs/output_folder.h"
#include "roevo_mrpt/config_file.h"
#include "runs.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

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

void writeReport(const CompareSettings& settings, const CompareResult& result) {
    const InterruptGuard guard;  // so that nothing is left in the temporary folder
    try {
        writeComparison(settings.output, result.sequences, result.info);
    } catch (const Interrupted&) {
        throw Interrupted(
            "interrupted while the report was being written: it was left as it was before; the runs are "
            "kept, and the same command" +
            std::string(settings.resume ? "" : " with --resume") + " writes it");
    }
}

}  // namespace

CompareResult compare(const CompareSettings& settings) {
    CompareResult result;
    std::optional<FolderLock> lock;
    std::exception_ptr fault;
    {
        const InterruptGuard guard;  // another one for the report: a second Ctrl-C ends that
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
        result.left = runs.left();
        runs.deliver();
    }
    if (result.interrupted && result.runs == 0)
        throw Interrupted("interrupted before any run was finished; no report was written");
    result.info = {settings.command, utcNow(), machineText(), softwareVersions(),
                   comparisonNotes(settings, result)};
    writeReport(settings, result);
    if (fault) std::rethrow_exception(fault);
    return result;
}

}  // namespace roevo
