#pragma once
#include <string>
#include <vector>

#include "roevo/options.h"

namespace roevo {

/// The options in force: defaults, then the config file, then each `section.key=value`, then the mode.
/// @param config_file, mode  may be empty
/// @throws UsageError that names the option and its value; std::runtime_error for an unreadable file
OdometryOptions collectOptions(const std::string& config_file, const std::vector<std::string>& settings,
                               const std::string& mode);

}  // namespace roevo
