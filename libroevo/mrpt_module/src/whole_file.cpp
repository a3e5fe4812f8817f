#include "whole_file.h"

#include <filesystem>
#include <stdexcept>

#include "input/regular_file.h"

namespace roevo {

void writeWholeFile(const std::string& file, const std::function<bool(const std::string&)>& write) {
    namespace fs = std::filesystem;
    const std::string temporary = file + ".part";
    std::error_code error;
    requireReplaceable(file);
    try {
        if (!write(temporary)) throw std::runtime_error("cannot write " + file + ": is the disk full?");
        fs::rename(temporary, file, error);
        if (error) throw std::runtime_error("cannot write " + file + ": " + error.message());
    } catch (...) {
        fs::remove(temporary, error);
        throw;
    }
}

}  // namespace roevo
