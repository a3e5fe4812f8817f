#include <immintrin.h>

#include "pixels/pixel_kernels.h"

namespace roevo::pixels {
namespace {
#include "side_kernels_impl.h"
}  // namespace

const Table* avx2() {
    static const Table table{"avx2", gradient, ridges,        remap,      halve,
                             refine, normals,  nearestPoints, depthPatch, side};
    return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace roevo::pixels
