#pragma once
#include <array>
#include <cstdint>

namespace roevo {

/// What the surroundings of a point look like, as 256 comparisons of grey levels.
struct Descriptor {
    static constexpr int kBits = 256, kWords = 4;
    std::array<std::uint64_t, kWords> words{};

    bool operator==(const Descriptor& other) const { return words == other.words; }
};

/// Number of bits that differ.
__attribute__((always_inline)) inline int hammingDistance(const Descriptor& a, const Descriptor& b) {
    int bits = 0;
    for (std::size_t w = 0; w < Descriptor::kWords; ++w)
        bits += __builtin_popcountll(a.words[w] ^ b.words[w]);
    return bits;
}

}  // namespace roevo
