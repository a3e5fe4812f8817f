#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace roevo {

/// What the surroundings of a point look like, as 256 comparisons of grey levels.
struct Descriptor {
    static constexpr int kBits = 256, kWords = 4;
    std::array<std::uint64_t, kWords> words{};
};

/// Number of bits that differ.
__attribute__((always_inline)) inline int hammingDistance(const Descriptor& a, const Descriptor& b) {
    int bits = 0;
    for (std::size_t w = 0; w < Descriptor::kWords; ++w)
        bits += __builtin_popcountll(a.words[w] ^ b.words[w]);
    return bits;
}

/// A point of an organized edge that can be told from others, also along its edge.
struct PlacePoint {
    float x = 0, y = 0, z = 0;  ///< in the keyframe's frame, m
    float u = 0, v = 0;         ///< ideal px
    float normal_angle = 0;     ///< of the edge's normal on the gradient's side, rad from the image's x axis
    Descriptor descriptor;

    /// What a file keeps of it.
    auto fields() { return std::tie(x, y, z, u, v, normal_angle, descriptor.words); }
};

/// What a keyframe is recognised by.
using PlacePoints = std::vector<PlacePoint>;

inline constexpr std::size_t kMaxPlacePoints = 400;
static_assert(kMaxPlacePoints * sizeof(PlacePoint) <= 40'000, "maps keep these for every keyframe");

}  // namespace roevo
