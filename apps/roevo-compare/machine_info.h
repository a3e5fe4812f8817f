#pragma once
#include <string>
#include <utility>
#include <vector>

namespace roevo {

/// Name of the processor, or "unknown processor".
std::string processorName();

/// One line: processor, cores that this process may use, memory, operating system.
std::string machineText();

/// Name and version of this software, of the libraries that it uses, and of the compiler.
std::vector<std::pair<std::string, std::string>> softwareVersions();

/// Changes when a program changes: the version of this software and a hash of the program's file.
/// @param file  of the program, by default the running one
std::string programState(const std::string& file = "/proc/self/exe");

/// The words of a command line, quoted where a shell would need it.
std::string shellCommand(const std::vector<std::string>& words);

/// The present time, ISO 8601, UTC, to the second.
std::string utcNow();

}  // namespace roevo
