#pragma once
/// One recording as people's folders have it: the same frames under other names, lists, cameras and kinds of
/// images.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo::test {

struct FolderKind {
    const char* name;
    const char* format;  ///< as which it is recognised
    /// Writes it. @param from  a recording at 30 Hz from 1 s on, with 5000 units per metre and an ideal lens
    /// @return arguments that the command line needs with it
    std::function<std::vector<std::string>(const DatasetReader& from, const std::filesystem::path& to)> write;
    enum { kSame, kOtherDepth, kOther } frames;  ///< how its frames compare with those that it was made of
};
inline void PrintTo(const FolderKind& kind, std::ostream* out) {
    *out << kind.name;
}

const std::vector<FolderKind>& folderKinds();

}  // namespace roevo::test
