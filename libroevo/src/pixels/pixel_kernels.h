#pragma once
/// The loops over all pixels of an image, compiled twice (portable baseline, AVX2) and chosen at run time.
/// Both give the same bytes. tests/ compares them with plain loops.

#include <cstddef>
#include <cstdint>

namespace roevo::pixels {

constexpr int kMostRidges = 64;       ///< pixels that ridges() looks at together
constexpr int kFractionBits = 5;      ///< of a pixel, in Remap
constexpr int kRemapPadding = 8 - 1;  ///< entries of a Remap that may be read past the last one

/// Where each pixel of a row comes from: the upper left of four neighbours, as an offset into the image, and
/// how far from it towards the right (low byte) and down (high byte), in 1/32 px (0 to 32).
struct Remap {
    const std::int32_t* offset;
    const std::int16_t* fraction;
};

struct Table {
    const char* name;
    /// One row of the 3x3 Sobel gradient, the outermost pixels repeated, and its Euclidean norm.
    void (*gradient)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                     int width, std::int16_t* gx, std::int16_t* gy, float* magnitude);
    /// Non-maximum suppression of `count` (at most kMostRidges) pixels of a row: a bit for each that is at
    /// least `low` and a ridge, the first in the lowest bit. Neighbours one row up and down and eight pixels
    /// further right must be there.
    /// @param stride  of the magnitude, pixels
    std::uint64_t (*ridges)(const float* magnitude, std::ptrdiff_t stride, const std::int16_t* gx,
                            const std::int16_t* gy, int count, float low);
    /// Bilinear samples of an 8-bit image (stride in bytes), rounded.
    void (*remap)(const std::uint8_t* image, std::ptrdiff_t stride, const Remap& from, int count,
                  std::uint8_t* out);
};

const Table& baseline();
const Table* avx2();  ///< nullptr where this processor lacks it
const Table& best();

}  // namespace roevo::pixels
