#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roevo {

/// Very many short lists of numbers that only grow, each in one piece of a common memory. Pieces have sizes
/// of powers of two; what a list outgrows is used again by others.
class BucketLists {
  public:
    /// @param count  lists, all empty; before anything is appended
    void reset(std::size_t count) { lists_.assign(count, {}); }
    void append(std::size_t list, std::uint32_t value);

    std::size_t length(std::size_t list) const { return lists_[list].length; }
    const std::uint32_t* begin(std::size_t list) const { return memory_.data() + lists_[list].first; }
    const std::uint32_t* end(std::size_t list) const { return begin(list) + length(list); }
    std::size_t bytes() const;

  private:
    struct List {
        std::uint32_t first = 0, length = 0;
    };
    std::uint32_t take(unsigned size_class);

    std::vector<List> lists_;
    std::vector<std::uint32_t> memory_;
    std::array<std::vector<std::uint32_t>, 32> free_;  ///< pieces of 2^k numbers
};

}  // namespace roevo
