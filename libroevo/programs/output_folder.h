#pragma once
#include <string>

namespace roevo {

/// Creates the folder when it is missing and tries that a file can be made in it, so that a program fails
/// before the work is done rather than after it. @throws std::runtime_error in one line
void prepareOutputFolder(const std::string& folder);

}  // namespace roevo
