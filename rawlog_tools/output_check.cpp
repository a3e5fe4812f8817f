#include "output_check.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "input/regular_file.h"
#include "programs/program.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {

namespace fs = std::filesystem;

void checkOutputFolder(const std::string& rawlog) {
    requireReplaceable(rawlog);
    const fs::path parent = fs::path(rawlog).parent_path();
    const fs::path folder = parent.empty() ? "." : parent;
    const auto fail = [&](const std::string& what) {
        throw std::runtime_error("cannot write " + rawlog + ": folder " + folder.string() + what);
    };
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (status.type() == fs::file_type::not_found) fail(" does not exist: create it");
    if (!fs::status_known(status)) fail(": " + error.message());
    if (!fs::is_directory(status)) fail(" is not a folder");
    if (access(folder.c_str(), W_OK | X_OK) != 0) fail(": " + std::string(std::strerror(errno)));
}

void warnOfForeignGroundTruth(const std::string& program, const std::string& rawlog) {
    warnOfForeignFile(program, RawlogWriter::groundTruthFile(rawlog), "ground truth");
}

void warnOfForeignFile(const std::string& program, const std::string& file, const std::string& what) {
    std::error_code unreadable;
    if (!fs::exists(file, unreadable)) return;
    printWarning(program.c_str(), file + " was there before and is not from this recording, which has no " +
                                      what + "; move it away");
}

}  // namespace roevo
