// All kernels as one instruction set has them; what kernels_impl.h says of itself holds here.
#include "residuals_impl.h"
#include "schur_impl.h"

constexpr Table tableNamed(const char* name) {
    return {name,          project,    exchangeMotion, patches,     referencePatch, accumulate,
            weighPatches,  sumPatches, liftPatches,    pick,        follow,         blur,
            edgeResiduals, weighEdges, liftEdges,      liftReadout, eliminatePoint};
}
