#pragma once
#include <string>

#include "roevo/options.h"

namespace roevo {

/// Sets the options that an .ini file names ("[section]" lines, "key = value" lines, comments with ; # or
/// //); the others stay.
/// @throws std::runtime_error with file and line: an unknown key (naming the closest known one), a value that
/// is no number or out of range, a line that is neither. `options` is then untouched.
void loadConfigFile(const std::string& file, OdometryOptions& options);

/// Same for text that is at hand. @param name  what to call it in errors
void loadConfigText(const std::string& text, const std::string& name, OdometryOptions& options);

/// Every option as .ini text, each with a comment: what it is, its unit and its range.
std::string toConfigText(const OdometryOptions& options);

/// Writes toConfigText() to a file, which appears when whole. @throws std::runtime_error
void saveConfigFile(const std::string& file, const OdometryOptions& options);

}  // namespace roevo
