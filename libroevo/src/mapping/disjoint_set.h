#pragma once
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace roevo {

/// Disjoint sets over 0..size-1, with union by size and path halving.
class DisjointSet {
  public:
    /// `size` sets of one element each.
    explicit DisjointSet(std::size_t size) : parent_(size), members_(size, 1) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }

    /// The element that stands for the set of `element`.
    std::size_t find(std::size_t element) {
        while (parent_[element] != element) {
            parent_[element] = parent_[parent_[element]];
            element = parent_[element];
        }
        return element;
    }

    /// Joins the sets of two elements. Returns whether they were apart.
    bool unite(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        if (members_[a] < members_[b]) std::swap(a, b);
        parent_[b] = a;
        members_[a] += members_[b];
        return true;
    }

  private:
    std::vector<std::size_t> parent_, members_;
};

}  // namespace roevo
