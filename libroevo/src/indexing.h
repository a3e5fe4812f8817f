#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace roevo {

/// The element of an array at an index of any integer type: those that are kept are small, or -1 for none.
template <class Array, class Index>
decltype(auto) at(Array&& array, Index index) {
    return std::forward<Array>(array)[static_cast<std::size_t>(index)];
}

/// Takes out the elements that a condition holds for; it is asked once for each, in order.
template <class T, class Condition>
void eraseIf(std::vector<T>& values, const Condition& condition) {
    values.erase(std::remove_if(values.begin(), values.end(), condition), values.end());
}

/// Half open.
struct IndexRange {
    std::size_t first = 0, end = 0;
    std::size_t size() const { return end - first; }
    /// Those at most `reach` places before and after `i`, which is one of them.
    IndexRange around(std::size_t i, std::size_t reach) const {
        return {i - std::min(reach, i - first), std::min(end, i + reach + 1)};
    }
};

/// Range number `i` where `begin` has the first of each and one past the last.
template <class Index>
IndexRange rangeOf(const std::vector<std::int32_t>& begin, Index i) {
    const std::int32_t* first = &at(begin, i);
    return {static_cast<std::size_t>(first[0]), static_cast<std::size_t>(first[1])};
}

}  // namespace roevo
