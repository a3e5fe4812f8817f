#pragma once
#include <vector>

#include "kernels/kernels.h"

namespace roevo {

/// All that this machine can run.
inline std::vector<const kernels::Table*> tables() {
    std::vector<const kernels::Table*> all{&kernels::baseline()};
    if (kernels::avx2() != nullptr) all.push_back(kernels::avx2());
    return all;
}

}  // namespace roevo
