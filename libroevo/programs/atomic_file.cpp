#include "programs/atomic_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <list>
#include <stdexcept>
#include <utility>

#include "input/regular_file.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

// Names of the temporary files alive, and of folders made for outputs, readable from a signal handler.
std::array<std::atomic<const char*>, 64> temporary_files{};

int registerFile(const char* path) {
    for (std::size_t i = 0; i < temporary_files.size(); ++i) {
        const char* expected = nullptr;
        if (temporary_files[i].compare_exchange_strong(expected, path)) return static_cast<int>(i);
    }
    return -1;
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
    throw std::runtime_error("cannot write " + path + ": " + what);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), temporary_path_(temporaryBeside(path_)) {
    requireReplaceable(path_);
    slot_ = registerFile(temporary_path_.c_str());
}

AtomicFile::~AtomicFile() {
    if (slot_ >= 0) temporary_files[static_cast<std::size_t>(slot_)] = nullptr;
    if (committed_) return;
    stream_.close();
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
}

std::ostream& AtomicFile::stream() {
    if (!stream_.is_open()) {
        errno = 0;
        stream_.open(temporary_path_, std::ios::binary);
        if (!stream_) fail(path_, errno ? std::strerror(errno) : "the file cannot be created");
    }
    return stream_;
}

void AtomicFile::close() {
    if (!stream_.is_open()) return;
    stream_.close();
    if (!stream_) fail(path_, "not everything could be written; is the disk full?");
}

void AtomicFile::commit() {
    close();
    std::error_code error;
    if (!fs::exists(temporary_path_, error)) fail(path_, "the file could not be created there");
    fs::rename(temporary_path_, path_, error);
    if (error) fail(path_, error.message());
    committed_ = true;
}

void writeAtomically(const std::string& path, const std::function<void(const std::string&)>& write) {
    AtomicFile file(path);
    write(file.temporaryPath());
    file.commit();
}

void writeTextAtomically(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.stream() << text;
    file.commit();
}

void removeIfLeftEmpty(const std::string& folder) {
    static auto& folders = *new std::list<std::string>;  // never freed: a handler may read them until the end
    registerFile(folders.emplace_back(folder).c_str());
}

void removeTemporaryFiles() noexcept {
    for (const auto& slot : temporary_files)
        if (const char* path = slot.load()) unlink(path);
    for (const auto& slot : temporary_files)
        if (const char* path = slot.load()) rmdir(path);
}

}  // namespace roevo
