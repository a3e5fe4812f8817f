#pragma once
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "input/excerpt.h"  // firstLine()

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
/// What cannot be caught ends the program with such a line, too. A limit on file sizes makes writing fail
/// instead of ending the program.
int runProgram(const char* name, const std::function<int()>& body);

/// Adds --version and parses. Use as `if (auto code = parseCommandLine(app, argc, argv)) return *code;`
/// @return nothing when the program should go on; 0 after --help or --version. Throws UsageError on wrong
/// usage, and for an option whose text is empty.
std::optional<int> parseCommandLine(CLI::App& app, int argc, const char* const* argv);

/// Version of this software, e.g. "0.1.0".
const char* versionText();

/// `name: warning: …` on stderr, in one line.
void printWarning(const char* name, const std::string& text);

/// Whether it says that memory has run out, which is no fault of the input that was at hand.
bool isOutOfMemory(const std::exception& fault);

/// What it says, in one line for the user.
std::string describe(const std::exception& fault);

}  // namespace roevo
