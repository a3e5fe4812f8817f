// All kernels as one instruction set has them; what lanes_impl.h says of itself holds here. Each file needs
// those before it.
// clang-format off
#include "lanes_impl.h"
#include "pixel_kernels_impl.h"
#include "edge_kernels_impl.h"
#include "side_kernels_impl.h"
#include "point_kernels_impl.h"
#include "residual_kernels_impl.h"
#include "schur_kernels_impl.h"
// clang-format on

constexpr Table tableNamed(const char* name) {
    return {name,          gradient,     ridges,     remap,       halve,          refine,  normals,
            nearestPoints, depthPatch,   side,       project,     exchangeMotion, patches, referencePatch,
            accumulate,    weighPatches, sumPatches, liftPatches, pick,           follow,  blur,
            edgeResiduals, weighEdges,   liftEdges,  liftReadout, eliminatePoint};
}
