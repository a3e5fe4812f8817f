#include "programs/program.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>

#include "programs/atomic_file.h"

namespace roevo {
namespace {

constexpr int kFailure = 1, kWrongUsage = 2;

void onSignal(int signal) {
    removeTemporaryFiles();
    _exit(128 + signal);
}

int fail(const char* name, const std::string& message, int code) {
    std::fflush(stdout);
    std::fprintf(stderr, "%s: error: %s\n", name, firstLine(message).c_str());
    return code;
}

}  // namespace

int runProgram(const char* name, const std::function<int()>& body) {
    std::signal(SIGCHLD,
                SIG_DFL);  // whoever started this may have ignored it: children could not be waited for
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
    try {
        return body();
    } catch (const UsageError& e) {
        return fail(name, std::string(e.what()) + " (see " + name + " --help)", kWrongUsage);
    } catch (const CLI::Error& e) {
        return fail(name, e.what(), kWrongUsage);
    } catch (const std::bad_alloc&) {
        return fail(name, "out of memory", kFailure);
    } catch (const std::exception& e) {
        return fail(name, e.what(), kFailure);
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
            throw UsageError("unknown argument '" + unknown.front() + "'");
        throw UsageError(e.what());
    }
    return std::nullopt;
}

const char* versionText() {
    return ROEVO_VERSION;
}

std::string firstLine(const std::string& message) {
    const std::size_t begin = message.find_first_not_of(" \n\r\t");
    if (begin == std::string::npos) return "unknown error";
    const std::size_t end = message.find_first_of("\r\n", begin);
    return message.substr(begin, end == std::string::npos ? end : end - begin);
}

}  // namespace roevo
