#include <immintrin.h>

#include "pixels/pixel_kernels.h"

namespace roevo::pixels {
namespace {
#include "side_kernels_impl.h"
}  // namespace

const Table* avx2() {
    static constexpr Table table = tableNamed("avx2");
    return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace roevo::pixels
