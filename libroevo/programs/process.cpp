#include "programs/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "programs/interrupt.h"

namespace roevo {
namespace {

constexpr std::size_t kLongestLine = 4096;  // the rest of a line is not kept
constexpr int kReadsAtOnce = 64;

struct Pipe {
    int ends[2] = {-1, -1};
    Pipe() {
        if (pipe2(ends, O_CLOEXEC) != 0)
            throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(errno));
    }
    ~Pipe() {
        for (const int fd : ends)
            if (fd >= 0) close(fd);
    }
    int takeReadEnd() { return std::exchange(ends[0], -1); }
};

// Binds this thread to a core while it is alive. A process that is made meanwhile inherits that from its very
// first instruction on, and here the system's refusal can be told.
class OnCore {
  public:
    explicit OnCore(int core) {
        if (core < 0) return;
        cpu_set_t only;
        CPU_ZERO(&only);
        CPU_SET(static_cast<std::size_t>(core), &only);
        bound_ = sched_getaffinity(0, sizeof before_, &before_) == 0 &&
                 sched_setaffinity(0, sizeof only, &only) == 0;
        if (!bound_) fault_ = "core " + std::to_string(core) + ": " + std::strerror(errno);
    }
    ~OnCore() {
        if (bound_) sched_setaffinity(0, sizeof before_, &before_);
    }
    OnCore(const OnCore&) = delete;
    OnCore& operator=(const OnCore&) = delete;

    const std::string& fault() const { return fault_; }

  private:
    cpu_set_t before_;
    bool bound_ = false;
    std::string fault_;
};

// Between fork() and exec: only functions that are safe there.
[[noreturn]] void becomeChild(char* const* argv, int out, int err, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);  // it died before the line above
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(argv[0], argv);
    const char* reason = strerrordesc_np(errno);
    if (write(STDERR_FILENO, "cannot be started: ", 19) < 0 || !reason ||
        write(STDERR_FILENO, reason, std::strlen(reason)) < 0)
        _exit(126);
    _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, int core, double timeout_s)
    : start_(std::chrono::steady_clock::now()), timeout_s_(timeout_s) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);

    Pipe out, err;
    const pid_t parent = getpid();
    const OnCore bound(core);
    binding_fault_ = bound.fault();
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(errno));
    if (pid_ == 0) becomeChild(argv.data(), out.ends[1], err.ends[1], parent);
    pid_fd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
    setpgid(pid_, pid_);  // in both processes, so that the group is there whoever comes first
    output_.fd = out.takeReadEnd();
    error_.fd = err.takeReadEnd();
    for (const int fd : {output_.fd, error_.fd}) fcntl(fd, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    if (running_) {
        kill(-pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    for (const int fd : {pid_fd_, output_.fd, error_.fd})
        if (fd >= 0) close(fd);
}

double ChildProcess::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool ChildProcess::update() {
    if (!running_) return false;
    if (!end_.timed_out && seconds() > timeout_s_) {
        end_.timed_out = true;
        kill(-pid_, SIGKILL);
    }
    // Its own children go while its number still is its own, that is before it is waited for
    siginfo_t info{};
    const bool unknown =
        waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 && errno == ECHILD;
    const bool ended = info.si_pid == pid_ || unknown;
    if (ended && !unknown) kill(-pid_, SIGKILL);
    output_.read();
    error_.read();
    if (!ended) return true;

    int status = 0;
    if (waitpid(pid_, &status, 0) != pid_) end_.exit_code = 1;  // nobody can tell any more
    running_ = false;
    if (!unknown && WIFEXITED(status)) end_.exit_code = WEXITSTATUS(status);
    if (!unknown && WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
    output_.finish();
    error_.finish();
    return false;
}

void ChildProcess::Stream::read() {
    char buffer[4096];
    ssize_t count = 0;
    // Not for ever, should it write faster than this reads
    for (int i = 0; i < kReadsAtOnce && (count = ::read(fd, buffer, sizeof buffer)) > 0; ++i)
        for (ssize_t k = 0; k < count; ++k)
            if (buffer[k] == '\n' || buffer[k] == '\r')
                finish();
            else if (partial.size() < kLongestLine)
                partial += buffer[k];
}

void ChildProcess::Stream::finish() {
    if (partial.find_first_not_of(" \t") != std::string::npos) line = partial;
    partial.clear();
}

void ChildProcess::waitForNews(const std::vector<const ChildProcess*>& processes, double seconds) {
    // Not for what they say, or the waiting one would wake up for every frame and take time from the others
    std::vector<pollfd> fds;
    for (const ChildProcess* process : processes)
        if (process->pid_fd_ >= 0) fds.push_back({process->pid_fd_, POLLIN, 0});
    poll(fds.data(), fds.size(), static_cast<int>(seconds * 1000));
}

const ProcessEnd& ChildProcess::finish() {
    constexpr double kLook = 0.1;  // s
    while (update()) {
        InterruptGuard::check();
        waitForNews({this}, kLook);
    }
    return end_;
}

std::string findProgram(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string file = (folder.empty() ? "." : folder) + "/" + name;
        std::error_code ignored;
        if (access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, ignored)) return file;
    }
    return {};
}

std::vector<int> allowedCores() {
    cpu_set_t set;
    std::vector<int> cores;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        for (int i = 0; i < CPU_SETSIZE; ++i)
            if (CPU_ISSET(static_cast<std::size_t>(i), &set)) cores.push_back(i);
    return cores;
}

}  // namespace roevo
