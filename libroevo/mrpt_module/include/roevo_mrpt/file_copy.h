#pragma once
#include <string>

namespace roevo {

/// Copies a file's bytes; an older `target` is replaced. @throws std::runtime_error naming both and the
/// reason, as the system gives it (no space left, no permission, …)
void copyFile(const std::string& source, const std::string& target);

/// The same without copying where both are on one disk: `target`, which must not exist, becomes a hard link
/// to the file (not to a symbolic link). @throws std::runtime_error as copyFile()
void linkOrCopyFile(const std::string& source, const std::string& target);

}  // namespace roevo
