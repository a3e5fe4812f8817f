#include <immintrin.h>

#include "tracking/kernels.h"

namespace roevo::kernels {
namespace {
#include "kernels_impl.h"
}  // namespace

const Table* avx2() {
    static const Table table{"avx2", project, patches, accumulate};
    return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace roevo::kernels
