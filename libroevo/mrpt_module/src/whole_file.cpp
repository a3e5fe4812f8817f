#include "whole_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "input/regular_file.h"

namespace roevo {

void writeWholeFile(const std::string& file, const std::function<bool(const std::string&)>& write) {
    namespace fs = std::filesystem;
    requireReplaceable(file);
    const std::string temporary = temporaryBeside(file);
    std::error_code error;
    try {
        errno = 0;
        if (!write(temporary)) {
            const int why = errno;
            // Of a file that was opened errno may not tell: much has been done since
            const bool opened = why == 0 || fs::exists(temporary, error);
            throw std::system_error(opened ? EIO : why, std::generic_category(),
                                    "cannot write " + file + (opened ? " (is the disk full?)" : ""));
        }
        fs::rename(temporary, file, error);
        if (error) throw std::system_error(error, "cannot write " + file);
    } catch (...) {
        fs::remove(temporary, error);
        throw;
    }
}

}  // namespace roevo
