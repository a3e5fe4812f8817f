#include "programs/program.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "programs/atomic_file.h"

namespace roevo {
namespace {

constexpr int kFailure = 1, kWrongUsage = 2;

const char* program_name = "";  // for terminate()

void onSignal(int signal) {
    removeTemporaryFiles();
    _exit(128 + signal);
}

int fail(const char* name, const std::string& message, int code) {
    removeTemporaryFiles();
    std::fflush(stdout);
    std::fprintf(stderr, "%s: error: %s\n", name, firstLine(message).c_str());
    return code;
}

// Of what nobody can catch: in a thread, or on the way out of something else.
[[noreturn]] void onTerminate() {
    try {
        if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
        fail(program_name, "ended by a fault of this program", kFailure);
    } catch (const std::exception& e) {
        fail(program_name, describe(e), kFailure);
    } catch (...) {
        fail(program_name, "ended by a fault of this program", kFailure);
    }
    _exit(kFailure);
}

}  // namespace

int runProgram(const char* name, const std::function<int()>& body) {
    std::signal(SIGCHLD,
                SIG_DFL);  // whoever started this may have ignored it: children could not be waited for
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit fails instead, and is reported
    program_name = name;
    std::set_terminate(onTerminate);
    try {
        const int code = body();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            return fail(name, "cannot write to the standard output: is the disk full?", kFailure);
        return code;
    } catch (const UsageError& e) {
        return fail(name, std::string(e.what()) + " (see " + name + " --help)", kWrongUsage);
    } catch (const CLI::Error& e) {
        return fail(name, e.what(), kWrongUsage);
    } catch (const std::exception& e) {
        return fail(name, describe(e), kFailure);
    }
}

std::optional<int> parseCommandLine(CLI::App& app, int argc, const char* const* argv) {
    app.set_version_flag("--version", app.get_name() + " " + versionText());
    app.get_formatter()->column_width(32);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {  // --help, --version
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        // CLI11 complains of a missing option before an unknown one, yet the unknown one is mostly why it is
        // missing.
        if (const auto unknown = app.remaining(); !unknown.empty())
            throw UsageError(unknown.front()[0] == '-' ? "unknown option '" + unknown.front() + "'"
                                                       : "'" + unknown.front() + "' belongs to no option");
        throw UsageError(e.what());
    }
    // Of a script's variable that is not set: the run would not be the one that was asked for
    for (const CLI::Option* option : app.get_options())
        for (const std::string& word : option->results())
            if (word.empty())
                throw UsageError(option->get_name() +
                                 ": its text is empty; give one, or leave the option out");
    return std::nullopt;
}

const char* versionText() {
    return ROEVO_VERSION;
}

void printWarning(const char* name, const std::string& text) {
    std::fprintf(stderr, "%s: warning: %s\n", name, firstLine(text).c_str());
}

bool isOutOfMemory(const std::exception& fault) {
    if (dynamic_cast<const std::bad_alloc*>(&fault)) return true;
    // OpenCV's own type, which not every program knows; MRPT may have wrapped it
    return std::string(fault.what()).find("Insufficient memory") != std::string::npos;
}

std::string describe(const std::exception& fault) {
    if (isOutOfMemory(fault))
        return "out of memory: close other programs, raise the limit (ulimit -v, --memory) or give smaller "
               "images";
    // Mostly a thread that has no room for its stack
    if (const auto* system = dynamic_cast<const std::system_error*>(&fault))
        if (system->code() == std::errc::resource_unavailable_try_again)
            return "cannot start a thread: a limit on memory or processes (ulimit -v, -u) is in the way";
    return firstLine(fault.what());
}

}  // namespace roevo
