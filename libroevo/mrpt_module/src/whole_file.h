#pragma once
#include <functional>
#include <string>

namespace roevo {

/// Lets `write` fill a temporary file beside `file` and renames it when whole; removes it when `write` throws
/// or fails.
/// @param write  returns false on failure
/// @throws std::system_error, which is a std::runtime_error, with errno's text; std::runtime_error when there
/// is something else than a file under that name
void writeWholeFile(const std::string& file, const std::function<bool(const std::string& temporary)>& write);

}  // namespace roevo
