#pragma once
#include <string>
#include <utility>
#include <vector>

namespace roevo {

/// One line: processor, cores that this process may use, memory, operating system.
std::string machineText();

/// Name and version of this software, of the libraries that it uses, and of the compiler.
std::vector<std::pair<std::string, std::string>> softwareVersions();

/// The words of a command line, quoted where a shell would need it.
std::string shellCommand(const std::vector<std::string>& words);

/// The present time, ISO 8601, UTC, to the second.
std::string utcNow();

}  // namespace roevo
