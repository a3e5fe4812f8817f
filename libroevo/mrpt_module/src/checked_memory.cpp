#include "checked_memory.h"

#include <mrpt/core/aligned_allocator.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>

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
