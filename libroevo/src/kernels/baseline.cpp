#include "kernels/kernels.h"

namespace roevo::kernels {
namespace {
#include "table_impl.h"
}  // namespace

const Table& baseline() {
    static constexpr Table table = tableNamed("baseline");
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
