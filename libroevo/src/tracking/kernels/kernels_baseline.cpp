#include "tracking/kernels.h"

namespace roevo::kernels {
namespace {
#include "residuals_impl.h"
#include "schur_impl.h"
}  // namespace

const Table& baseline() {
    static const Table table{"baseline",  project,       exchangeMotion, patches,     referencePatch,
                             accumulate,  weighPatches,  sumPatches,     liftPatches, pick,
                             follow,      blur,          edgeResiduals,  weighEdges,  liftEdges,
                             liftReadout, eliminatePoint};
    return table;
}

#if !defined(ROEVO_HAVE_AVX2)
const Table* avx2() {
    return nullptr;
}
#endif

const Table& best() {
    static const Table& table = avx2() != nullptr ? *avx2() : baseline();
    return table;
}

}  // namespace roevo::kernels
