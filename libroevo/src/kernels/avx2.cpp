#include <immintrin.h>

#include "kernels/kernels.h"

namespace roevo::kernels {
namespace {
#include "table_impl.h"
}  // namespace

const Table* avx2() {
    static constexpr Table table = tableNamed("avx2");
    return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace roevo::kernels
