#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "roevo/options.h"

namespace CLI {
class App;
}

namespace roevo {

/// Checks for CLI11, whose own would print the largest number that there is, of 309 digits.
/// @return empty when it is a finite number from 0 to 1e12, or a whole one of `least` or more
std::string faultOfNumber(const std::string& word);
std::string faultOfCount(const std::string& word, std::size_t least);

/// The options --first and --skip. @param of  which frames, for the help: " of each recording"; may be empty
void addFrameOptions(CLI::App& app, std::size_t& first, std::size_t& skip, const std::string& of = "");

/// The option --set, for collectOptions().
void addSetOption(CLI::App& app, std::vector<std::string>& settings);

/// The options in force: defaults, then the config file, then each `section.key=value`, then the mode.
/// @param config_file, mode  may be empty
/// @throws UsageError that names the option and its value; std::runtime_error for an unreadable file
OdometryOptions collectOptions(const std::string& config_file, const std::vector<std::string>& settings,
                               const std::string& mode);

}  // namespace roevo
