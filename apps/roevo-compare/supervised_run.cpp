#include "supervised_run.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "core_claim.h"
#include "programs/interrupt.h"
#include "programs/process.h"
#include "programs/program.h"
#include "rows.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kWait = 0.2;  // s between two looks at the process

void removeFolder(const fs::path& folder) {
    std::error_code fault;
    fs::remove_all(folder, fault);
    if (fault) throw std::runtime_error("cannot remove " + folder.string() + ": " + fault.message());
}

void createFolder(const fs::path& folder) {
    std::error_code fault;
    fs::create_directories(folder, fault);
    if (fault) throw std::runtime_error("cannot create " + folder.string() + ": " + fault.message());
}

// Puts a folder into the place of another one, if there is one; `from` may still be there afterwards, as
// that.
void moveTo(const fs::path& from, const fs::path& to) {
    // In one step, so that a run is not lost if the power goes right now
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
    removeFolder(to);
    std::error_code fault;
    fs::rename(from, to, fault);
    if (fault) throw std::runtime_error("cannot create " + to.string() + ": " + fault.message());
}

// The folder where the run is made, beside the one where it is kept: of this process, on whatever machine.
class PartialFolder {
  public:
    explicit PartialFolder(const fs::path& kept) {
        char host[256] = "";
        gethostname(host, sizeof host - 1);
        path_ = kept.parent_path() /
                ("." + kept.filename().string() + "." + host + "." + std::to_string(getpid()) + ".partial");
        empty();
    }
    ~PartialFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    PartialFolder(const PartialFolder&) = delete;
    PartialFolder& operator=(const PartialFolder&) = delete;

    void empty() const {
        removeFolder(path_);
        createFolder(path_);
    }
    std::string path() const { return path_.string(); }

  private:
    fs::path path_;
};

// The message of an error line of ours without the program's name, other lines as they are.
std::string lastWords(const std::string& line) {
    constexpr char kMark[] = ": error: ";
    const std::size_t mark = line.find(kMark);
    return mark == std::string::npos ? line : line.substr(mark + std::strlen(kMark));
}

// Why there is no result of a process that did not say it in its row.
std::string failureOf(const ChildProcess& process, std::size_t frames, double timeout_s) {
    const ProcessEnd& end = process.end();
    const std::string words = lastWords(process.lastError());
    const std::string quoted = words.empty() ? "" : "; its last words: " + words;
    const std::string after = " after " + std::to_string(frames) + (frames == 1 ? " frame" : " frames");
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g s", timeout_s);
    if (end.timed_out) return "it was not done within " + std::string(limit) + ", ended" + after + quoted;
    if (end.signal != 0) {
        std::string name = strsignal(end.signal);
        if (end.signal == SIGKILL) name += ", maybe for want of memory";
        return "it died of signal " + std::to_string(end.signal) + " (" + name + ")" + after + quoted;
    }
    return "it ended with exit code " + std::to_string(end.exit_code) + after +
           (words.empty() ? " without a word" : quoted);
}

// What the ended process has left, or a row that says why there is nothing.
SequenceComparison outcome(const RunTask& task, const ChildProcess& process, const std::string& folder) {
    SequenceComparison failed;
    failed.name = task.sequence;
    failed.input = task.input;
    failed.runs.emplace_back();
    MethodRun& run = failed.runs[0];
    run.frames = readProgress(folder).frames;
    const ProcessEnd& end = process.end();
    try {
        if (!end.timed_out && end.signal == 0)
            if (SequenceComparison row = readRow(folder); end.ok() || !row.runs[0].ok()) {
                if (!row.runs[0].ok()) row.runs[0].frames = run.frames;
                return row;
            }
    } catch (const std::exception& e) {
        if (end.ok()) run.failure = "it ended well, but left no result: " + firstLine(e.what());
    }
    if (run.failure.empty()) run.failure = failureOf(process, run.frames, task.timeout_s);
    return failed;
}

}  // namespace

SequenceComparison supervisedRun(const RunTask& task, const CommandFor& command,
                                 const std::function<void(const Advance&)>& going) {
    const PartialFolder folder(task.folder);
    const CoreClaim core;
    ChildProcess process(command(folder.path()), core.core(), task.timeout_s);
    while (process.update()) {
        InterruptGuard::check();
        if (going) going(readProgress(folder.path()));
        ChildProcess::waitForNews({&process}, kWait);
    }
    SequenceComparison row = outcome(task, process, folder.path());
    MethodRun& run = row.runs[0];
    run.method = task.method.name;
    run.label = task.method.label;
    run.note = task.method.note;
    run.input = task.input;
    run.key = task.key;
    run.not_pinned = core.core() < 0 ? core.fault() : process.bindingFault();
    if (run.ok())
        fs::remove(ProgressFile::path(folder.path()));
    else
        folder.empty();  // whatever else is there is of no result
    writeRow(folder.path(), row);
    moveTo(folder.path(), task.folder);
    row.run_folders = {task.folder};
    return row;
}

}  // namespace roevo
