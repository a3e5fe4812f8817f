#pragma once
#include <string>
#include <vector>

namespace roevo {

/// Creates the folder when it is missing and tries that a file can be made in it, so that a program fails
/// before the work is done rather than after it. @throws std::runtime_error in one line
void prepareOutputFolder(const std::string& folder);

/// Whether a file, there or not, lies in a folder or below it.
bool isWithin(const std::string& file, const std::string& folder);

/// Whether two names, of files there or not, are of one place. Empty ones are none.
bool isSameFile(const std::string& a, const std::string& b);

/// Refuses to write over what is read: one of these files, whatever is in a folder of them, or the images
/// beside a rawlog. Empty names are none. Throws UsageError naming the option.
void keepInputs(const char* option, const std::string& output, const std::vector<std::string>& inputs);

}  // namespace roevo
