#include "recordings/bags/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "input/regular_file.h"

namespace roevo {
namespace {

constexpr std::uint64_t kSmallestRead = 4096;

void requireInside(std::uint64_t offset, std::uint64_t count, std::uint64_t size) {
    if (offset > size || count > size - offset) throw std::runtime_error("it ends too early");
}

}  // namespace

std::string_view MemoryBytes::read(std::uint64_t offset, std::uint64_t count) {
    requireInside(offset, count, size());
    return bytes_.substr(offset, count);
}

FileBytes::FileBytes(const std::string& path) : path_(path) {
    requireRegularInput(path);
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (file_ < 0 || fstat(file_, &status) != 0) {
        const std::string why = std::strerror(errno);
        if (file_ >= 0) close(file_);
        throw std::runtime_error("cannot read " + path + ": " + why);
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() {
    close(file_);
}

std::string_view FileBytes::read(std::uint64_t offset, std::uint64_t count) {
    requireInside(offset, count, size_);
    if (offset < begin_ || offset + count > begin_ + buffer_.size()) {
        buffer_.resize(std::min(std::max(count, kSmallestRead), size_ - offset));
        begin_ = offset;
        for (std::size_t done = 0; done < buffer_.size();) {
            const ssize_t got =
                pread(file_, buffer_.data() + done, buffer_.size() - done, static_cast<off_t>(offset + done));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) {
                buffer_.clear();
                throw std::runtime_error("cannot read " + path_ + ": " +
                                         (got < 0 ? std::strerror(errno) : "it has become shorter"));
            }
            done += static_cast<std::size_t>(got);
        }
    }
    return std::string_view(buffer_).substr(offset - begin_, count);
}

}  // namespace roevo
