#include "run_queue.h"

#include <fcntl.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "programs/interrupt.h"
#include "programs/program.h"
#include "run_progress.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kWait = 0.2;  // s between two looks at the processes

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

// The message of an error line of ours without the program's name, other lines as they are.
std::string lastWords(const std::string& line) {
    constexpr char kMark[] = ": error: ";
    const std::size_t mark = line.find(kMark);
    return mark == std::string::npos ? line : line.substr(mark + std::strlen(kMark));
}

std::string inFrames(std::size_t frames) {
    return " after " + std::to_string(frames) + (frames == 1 ? " frame" : " frames");
}

// Why there is no result of a process that did not say it in its run.json.
std::string failureOf(const ChildProcess& process, std::size_t frames, double timeout_s) {
    const ProcessEnd& end = process.end();
    const std::string words = lastWords(process.lastError());
    const std::string quoted = words.empty() ? "" : "; its last words: " + words;
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g s", timeout_s);
    if (end.timed_out)
        return "it was not done within " + std::string(limit) + ", ended" + inFrames(frames) + quoted;
    if (end.signal != 0) {
        std::string name = strsignal(end.signal);
        if (end.signal == SIGKILL) name += ", maybe for want of memory";
        return "it died of signal " + std::to_string(end.signal) + " (" + name + ")" + inFrames(frames) +
               quoted;
    }
    return "it ended with exit code " + std::to_string(end.exit_code) + inFrames(frames) +
           (words.empty() ? " without a word" : quoted);
}

// One run under way, in a folder beside the one where it is kept.
class ActiveRun {
  public:
    ActiveRun(const RunTask& task, std::size_t index, const CommandFor& command, int core, double timeout_s)
        : index(index), core(core), task_(task), timeout_s_(timeout_s) {
        const fs::path folder = task.folder;
        partial_ = folder.parent_path() / ("." + folder.filename().string() + ".partial");
        removeFolder(partial_);  // of a program that was killed
        createFolder(partial_);
        process_.emplace(command(task, partial_.string()), core, timeout_s);
    }
    ~ActiveRun() {
        process_.reset();
        std::error_code ignored;
        fs::remove_all(partial_, ignored);
    }
    ActiveRun(const ActiveRun&) = delete;
    ActiveRun& operator=(const ActiveRun&) = delete;

    bool update() { return process_->update(); }
    double share() const { return readProgress(partial_.string()).share; }
    const ChildProcess& process() const { return *process_; }

    // Moves the ended run to where it is kept.
    MethodRun keep(std::size_t jobs) {
        MethodRun run = result();
        run.method = task_.method.name;
        run.label = task_.method.label;
        run.note = task_.method.note;
        run.input = task_.input;
        run.jobs = jobs;
        run.not_pinned = core < 0 ? "the system does not tell its cores" : process_->bindingFault();
        run.settings = task_.settings;
        writeMethodRun(partial_.string(), run);
        moveTo(partial_, task_.folder);
        return run;
    }

    const std::size_t index;
    const int core;

  private:
    MethodRun result() {
        const std::size_t frames = readProgress(partial_.string()).frames;
        MethodRun run = outcome(frames);
        if (run.failure.empty()) {
            fs::remove(ProgressFile::path(partial_.string()));
        } else {  // whatever else is there is of no result
            run.frames = frames;
            removeFolder(partial_);
            createFolder(partial_);
        }
        return run;
    }

    MethodRun outcome(std::size_t frames) const {
        const ProcessEnd& end = process_->end();
        const bool ended_itself = !end.timed_out && end.signal == 0;
        MethodRun failed;
        if (end.timed_out)
            failed.timeout_s = timeout_s_;
        else
            failed.signal = end.signal;
        try {
            if (ended_itself)
                if (MethodRun run = readMethodRun(partial_.string()); end.ok() || !run.ok()) return run;
        } catch (const std::exception& e) {
            if (end.ok()) failed.failure = "it ended well, but left no result: " + firstLine(e.what());
        }
        if (failed.failure.empty()) failed.failure = failureOf(*process_, frames, timeout_s_);
        return failed;
    }

    const RunTask& task_;
    const double timeout_s_;
    fs::path partial_;
    std::optional<ChildProcess> process_;
};

}  // namespace

void runTasks(const std::vector<RunTask>& tasks, const CommandFor& command, const QueueOptions& options,
              QueueObserver& observer) {
    std::vector<std::unique_ptr<ActiveRun>> active;
    std::vector<int> free_cores(options.cores.rbegin(), options.cores.rend());
    std::size_t started = 0;
    const std::size_t jobs = std::min(options.cores.size(), tasks.size());
    while (started < tasks.size() || !active.empty()) {
        InterruptGuard::check();
        while (started < tasks.size() && !free_cores.empty()) {
            active.push_back(std::make_unique<ActiveRun>(tasks[started], started, command, free_cores.back(),
                                                         options.timeout_s));
            free_cores.pop_back();
            ++started;
        }
        std::vector<const ChildProcess*> processes;
        std::map<std::size_t, double> shares;
        for (const auto& run : active) {
            processes.push_back(&run->process());
            shares[run->index] = run->share();
        }
        observer.going(shares);
        ChildProcess::waitForNews(processes, kWait);
        for (auto run = active.begin(); run != active.end();) {
            if ((*run)->update()) {
                ++run;
                continue;
            }
            const double seconds = (*run)->process().seconds();
            const MethodRun result = (*run)->keep(jobs);
            free_cores.push_back((*run)->core);
            const std::size_t index = (*run)->index;
            run = active.erase(run);
            observer.finished(index, result, seconds);
        }
    }
}

}  // namespace roevo
