#pragma once
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace roevo {

/// What is there under that name instead of a regular file: "it is a folder", "it is a pipe", …; empty when
/// it is one, when nothing is there, or when it cannot be seen.
inline std::string otherThanFile(const std::filesystem::path& path) {
    using std::filesystem::file_type;
    std::error_code unseen;
    switch (std::filesystem::status(path, unseen).type()) {
        case file_type::directory:
            return "it is a folder";
        case file_type::fifo:
            return "it is a pipe, not a file";
        case file_type::character:
        case file_type::block:
            return "it is a device, not a file";
        case file_type::socket:
            return "it is a socket, not a file";
        default:
            return "";
    }
}

/// For files that are to be read: a pipe might be waited for without end, a device might have no end.
/// @throws std::runtime_error that names it
inline void requireRegularInput(const std::filesystem::path& path) {
    if (const std::string other = otherThanFile(path); !other.empty())
        throw std::runtime_error("cannot read " + path.string() + ": " + other);
}

/// For files that are to be written under a temporary name: renaming would put a file in a device's place.
/// @throws std::runtime_error that names it
inline void requireReplaceable(const std::filesystem::path& path) {
    if (const std::string other = otherThanFile(path); !other.empty())
        throw std::runtime_error("cannot write " + path.string() + ": " + other + "; give a file name");
}

/// A name in the same folder that nobody else has, with the same extension.
inline std::string temporaryBeside(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter{0};
    const std::string name = "." + path.stem().string() + ".partial-" + std::to_string(getpid()) + "-" +
                             std::to_string(counter++) + path.extension().string();
    return (path.parent_path() / name).string();
}

}  // namespace roevo
