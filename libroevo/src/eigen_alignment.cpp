#include "roevo/types.h"

namespace roevo {

template <int bytes>
bool builtWithEigenAlignment() {
    return true;
}
template bool builtWithEigenAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>();

}  // namespace roevo
