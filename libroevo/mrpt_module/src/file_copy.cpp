#include "roevo_mrpt/file_copy.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace roevo {
namespace {

/// errno of the first call that fails, else 0. std::filesystem::copy_file() says "I/O error" of a full disk.
int copyBytes(int from, int to) {
    std::vector<char> buffer(1 << 18);
    for (;;) {
        const ssize_t got = read(from, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return got < 0 ? errno : 0;
        for (ssize_t done = 0; done < got;) {
            const ssize_t put = write(to, buffer.data() + done, static_cast<std::size_t>(got - done));
            if (put < 0 && errno != EINTR) return errno;
            if (put > 0) done += put;
        }
    }
}

}  // namespace

void copyFile(const std::string& source, const std::string& target) {
    const auto fail = [&](int fault) {
        throw std::runtime_error("cannot copy " + source + " to " + target + ": " + std::strerror(fault));
    };
    const int from = open(source.c_str(), O_RDONLY | O_CLOEXEC);
    if (from < 0) fail(errno);
    const int to = open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int fault = to < 0 ? errno : copyBytes(from, to);
    if (to >= 0 && close(to) != 0 && fault == 0) fault = errno;
    close(from);
    if (fault != 0) fail(fault);
}

void linkOrCopyFile(const std::string& source, const std::string& target) {
    std::error_code error;
    const auto file = std::filesystem::canonical(source, error);
    if (error) throw std::runtime_error("cannot read " + source + ": " + error.message());
    std::filesystem::create_hard_link(file, target, error);
    // Writing into a link of an earlier time would write into the file that it shares
    if (error == std::errc::file_exists)
        throw std::runtime_error("cannot link " + source + " to " + target + ": " + error.message());
    if (error) copyFile(source, target);
}

}  // namespace roevo
