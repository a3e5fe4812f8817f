#include "checked_memory.h"

#include <mrpt/core/aligned_allocator.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>

void* mrpt::aligned_malloc(size_t size, size_t alignment) {
    if (size > roevo::kLargestMrptBlock) throw std::length_error("more memory than any observation needs");
    const std::size_t whole_blocks = (size + alignment - 1) / alignment * alignment;
    void* const block = std::aligned_alloc(alignment, whole_blocks);
    if (block == nullptr && size > 0) throw std::bad_alloc();
    return block;
}

void* mrpt::aligned_calloc(size_t size, size_t alignment) {
    void* const block = mrpt::aligned_malloc(size, alignment);
    if (block != nullptr) std::memset(block, 0, size);
    return block;
}

void mrpt::aligned_free(void* block) {
    std::free(block);
}

mrpt::serialization::CArchive& mrpt::serialization::operator>>(CArchive& archive, std::string& text) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::uint32_t size = 0;
    archive >> size;
    if (size > roevo::kLargestMrptBlock) throw std::length_error("a longer text than any observation has");
    text.clear();
    while (text.size() < size) {
        const std::size_t before = text.size();
        text.resize(before + std::min(kPiece, size - before));
        if (archive.ReadBuffer(text.data() + before, text.size() - before) != text.size() - before)
            throw std::runtime_error("the file ends within a text");
    }
    return archive;
}

namespace roevo {

void useCheckedMrptMemory() {}

void requireRoom(std::size_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    std::size_t pages = 0;  // that the process has mapped
    std::ifstream("/proc/self/statm") >> pages;
    if (pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + bytes > limit.rlim_cur)
        throw std::bad_alloc();
}

}  // namespace roevo
