#pragma once
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace roevo {

/// Wrong usage that the command-line parser itself cannot see: ends the program with exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Runs a program's body and turns what it throws into one line on stderr, `name: error: ...`.
/// @return the body's exit code; 1 on an exception; 2 on wrong usage (UsageError or a CLI11 error)
int runProgram(const char* name, const std::function<int()>& body);

/// Adds --version and parses. Use as `if (auto code = parseCommandLine(app, argc, argv)) return *code;`
/// @return nothing when the program should go on; 0 after --help or --version. Throws UsageError on wrong
/// usage.
std::optional<int> parseCommandLine(CLI::App& app, int argc, const char* const* argv);

/// Version of this software, e.g. "0.1.0".
const char* versionText();

/// First meaningful line of an exception's text: MRPT's carry the source position and a call stack.
std::string firstLine(const std::string& message);

}  // namespace roevo
