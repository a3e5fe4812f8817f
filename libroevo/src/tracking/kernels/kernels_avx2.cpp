#include <immintrin.h>

#include "tracking/kernels.h"

namespace roevo::kernels {
namespace {
#include "residuals_impl.h"
#include "schur_impl.h"
}  // namespace

const Table* avx2() {
    static const Table table{"avx2",      project,       exchangeMotion, patches,     referencePatch,
                             accumulate,  weighPatches,  sumPatches,     liftPatches, pick,
                             follow,      blur,          edgeResiduals,  weighEdges,  liftEdges,
                             liftReadout, eliminatePoint};
    return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace roevo::kernels
