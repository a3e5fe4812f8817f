#include "place/bucket_lists.h"

#include <algorithm>

namespace roevo {

void BucketLists::append(std::size_t list, std::uint32_t value) {
    List& at = lists_[list];
    const bool full = (at.length & (at.length - 1)) == 0;  // 0, 1, 2, 4, 8 ...: as long as its piece
    if (full) {
        const auto size_class = at.length == 0 ? 0U : static_cast<unsigned>(__builtin_ctz(at.length)) + 1;
        const std::uint32_t piece = take(size_class);
        std::copy_n(memory_.begin() + at.first, at.length, memory_.begin() + piece);
        if (at.length > 0) free_[size_class - 1].push_back(at.first);
        at.first = piece;
    }
    memory_[at.first + at.length++] = value;
}

std::uint32_t BucketLists::take(unsigned size_class) {
    auto& pieces = free_[size_class];
    if (!pieces.empty()) {
        const std::uint32_t piece = pieces.back();
        pieces.pop_back();
        return piece;
    }
    const auto piece = static_cast<std::uint32_t>(memory_.size());
    memory_.resize(memory_.size() + (std::size_t{1} << size_class));
    return piece;
}

std::size_t BucketLists::bytes() const {
    std::size_t numbers = memory_.capacity();
    for (const auto& pieces : free_) numbers += pieces.capacity();
    return numbers * sizeof(std::uint32_t) + lists_.capacity() * sizeof(List);
}

}  // namespace roevo
