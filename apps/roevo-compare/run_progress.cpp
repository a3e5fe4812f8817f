#include "run_progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace roevo {

std::string ProgressFile::path(const std::string& folder) {
    return (std::filesystem::path(folder) / "progress.txt").string();
}

ProgressFile::ProgressFile(const std::string& folder)
    : fd_(open(path(folder).c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644)) {
    if (fd_ < 0) throw std::runtime_error("cannot write " + path(folder) + ": " + std::strerror(errno));
}

ProgressFile::~ProgressFile() {
    close(fd_);
}

void ProgressFile::write(const Advance& advance) const {
    char line[64];  // always as long, and in one piece: whoever reads it finds a whole line
    const int length = std::snprintf(line, sizeof line, "%20zu %.6f\n", advance.frames, advance.share);
    // A full disk costs the display, not the run
    [[maybe_unused]] const ssize_t written = pwrite(fd_, line, static_cast<std::size_t>(length), 0);
}

Advance readProgress(const std::string& folder) {
    std::ifstream in(ProgressFile::path(folder));
    Advance advance;
    if (!(in >> advance.frames >> advance.share) || !(advance.share >= 0 && advance.share <= 1)) return {};
    return advance;
}

}  // namespace roevo
