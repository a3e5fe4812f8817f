#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace roevo {

/// How a process came to its end.
struct ProcessEnd {
    int exit_code = 0;
    int signal = 0;          ///< that ended it, 0: none
    bool timed_out = false;  ///< it was ended because its time was up

    bool ok() const { return exit_code == 0 && signal == 0 && !timed_out; }
};

/// A program that runs beside this one, in a process group of its own (Ctrl-C does not reach it), bound to
/// one processor core. It ends with this object, and with the thread that made it, with all its own children.
class ChildProcess {
  public:
    /// @param command    path of the program, then its arguments
    /// @param core       processor that it may use; -1: any
    /// @param timeout_s  s, after which it is ended
    /// @throws std::runtime_error when the system cannot make another process
    ChildProcess(const std::vector<std::string>& command, int core, double timeout_s);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Why it could not be bound to its core, and runs on any; empty when it is bound, or was to run on any.
    const std::string& bindingFault() const { return binding_fault_; }

    /// Takes in what the process has said, and ends it when its time is up. @return whether it still runs
    bool update();

    /// Waits for its end. @throws Interrupted after a signal (needs an InterruptGuard); it still runs then
    const ProcessEnd& finish();

    /// Valid once update() has returned false.
    const ProcessEnd& end() const { return end_; }

    /// Last whole line that is not empty on its standard output and standard error; after its end the last
    /// line even without an end of line.
    const std::string& lastOutput() const { return output_.line; }
    const std::string& lastError() const { return error_.line; }

    double seconds() const;  ///< since its start
    pid_t id() const { return pid_; }

    /// Waits until one of them ends, at most so long. Signals end the wait.
    static void waitForNews(const std::vector<const ChildProcess*>& processes, double seconds);

  private:
    struct Stream {
        int fd = -1;
        std::string line, partial;
        void read();
        void finish();  ///< what has been read since the last line is a line
    };

    pid_t pid_ = -1;
    int pid_fd_ = -1;  ///< readable once the process has ended; -1 where the system has no such thing
    bool running_ = true;
    ProcessEnd end_;
    std::string binding_fault_;
    Stream output_, error_;
    std::chrono::steady_clock::time_point start_;
    double timeout_s_;
};

/// Path of a program as a shell finds it by PATH; empty when there is none.
std::string findProgram(const std::string& name);

/// Numbers of the processor cores that this process may use.
std::vector<int> allowedCores();

}  // namespace roevo
