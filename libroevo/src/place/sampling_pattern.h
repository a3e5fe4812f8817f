#pragma once
#include <array>
#include <cstdint>

#include "place/place_points.h"

namespace roevo {

/// Where a descriptor samples the image, in units of the patch's radius, with the edge's normal as first
/// axis: one site in the middle and rings about it, each the mean over a square that grows with the ring.
struct SamplingPattern {
    static constexpr int kSites = 49;
    struct Site {
        float along_normal, along_edge;  ///< shares of the radius
        float half_width;                ///< of the square, share of the radius
    };
    struct Comparison {
        std::uint8_t first, second;  ///< sites; the bit is set where the first one is brighter
    };
    std::array<Site, kSites> sites;
    std::array<Comparison, Descriptor::kBits> comparisons;
};

/// The one pattern that all descriptors are made with: computed, always the same.
const SamplingPattern& samplingPattern();

}  // namespace roevo
