// One target for libFuzzer; the build says which.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const roevo::fuzz::Target& target : roevo::fuzz::targets())
        if (std::strcmp(target.name, ROEVO_FUZZ_TARGET) == 0) {
            try {
                target.run({reinterpret_cast<const char*>(data), size});
            } catch (const std::exception& error) {
                std::fprintf(stderr, "%s: %s\n", target.name, error.what());
                std::abort();
            }
        }
    return 0;
}
