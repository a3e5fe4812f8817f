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

/// A bit for each pixel that is a ridge, the first in the lowest bit.
struct Ridges {
    std::uint64_t all;     ///< of at least the low threshold
    std::uint64_t strong;  ///< of them, those of at least the high one
};

/// A gradient image whose rows follow each other without gaps.
struct GradientView {
    const std::int16_t *gx, *gy;
    const float* magnitude;
    int width;  ///< px
};

/// Points of edges, one array for each of their numbers (see OrganizedEdges).
struct EdgePointArrays {
    float *x, *y, *gradient_x, *gradient_y, *strength;
};

constexpr int kMostPatch = 7;  ///< px, side of the squares that depthPatch() looks at

/// A square of depths, eight columns of which can be read.
struct DepthSquare {
    const float* depth;           ///< m, its first one
    std::ptrdiff_t stride;        ///< of its rows, in depths
    int size;                     ///< at most kMostPatch
    const float *columns, *rows;  ///< eight each: their offsets from its centre, px
};

struct DepthLimits {
    float near, far;  ///< m, of depths that are used
    float jump;       ///< factor between depths that follow each other on one surface
    int least;        ///< depths; fewer are speckle
};

/// The nearest surface in a square of depths.
struct DepthPatch {
    int count;                ///< of its depths; 0: there is none
    float nearest, farthest;  ///< of them, m
    float inverse;            ///< 1/m, of their plane, or of their mean where they span none
};

constexpr int kCellWidth = 4, kCellHeight = 8;  ///< px, of EdgeCells
constexpr int kGridPadding = 8 - 1;             ///< points that may be read past the last one

/// Points of edges in cells, row after row of them.
struct EdgeCells {
    const float *x, *y, *normal_x, *normal_y;  ///< px; past the last point x is far from everything
    const std::int32_t* index;                 ///< by which a point is known
    const std::int32_t* first;                 ///< point of each cell, and where the last one's end
    int columns, rows;
};

/// A depth image, m.
struct DepthView {
    const float* data;
    std::ptrdiff_t stride;  ///< pixels
    int width, height;
};

/// A point of an edge in such an image, px, m.
struct EdgePoint {
    double x, y, normal_x, normal_y;
    float depth;
};

/// Which pixels side() looks at: those on one side of the edge that are next to the normal in columns (or
/// rows, whatever the normal rather runs along) up to `steps` from the point's own one; in it and near it
/// only as many as fill up what is looked at together.
struct SideReach {
    bool by_column;
    int centre;       ///< column (or row) that the point is in
    int steps;        ///< columns (or rows) from there
    bool along;       ///< the side that the normal points to
    double clear;     ///< px; nearer samples are left out
    float jump;       ///< relative step of depth beyond which is another surface
    double widening;  ///< px from the edge at which the step may be twice as large; 0: it never is
};

/// Sums over samples on one side of an edge: distances s from the edge (px) and inverse depths q (relative to
/// the edge's, minus 1) of those on the edge's own surface, by their weights.
struct SideSums {
    double count = 0, s = 0, q = 0, ss = 0;
    double sq = 0, qq = 0;
    double seen = 0, behind = 0;  ///< weights on whatever surface, and on the background
};

struct Table {
    const char* name;
    /// One row of the 3x3 Sobel gradient, the outermost pixels repeated, and its Euclidean norm.
    void (*gradient)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                     int width, std::int16_t* gx, std::int16_t* gy, float* magnitude);
    /// Non-maximum suppression of `count` (at most kMostRidges) pixels of a row. Neighbours one row up and
    /// down and eight pixels further right must be there.
    /// @param stride  of the magnitude, pixels
    Ridges (*ridges)(const float* magnitude, std::ptrdiff_t stride, const std::int16_t* gx,
                     const std::int16_t* gy, int count, float low, float high);
    /// Bilinear samples of an 8-bit image (stride in bytes; nothing from `end` on is read), rounded.
    void (*remap)(const std::uint8_t* image, const std::uint8_t* end, std::ptrdiff_t stride,
                  const Remap& from, int count, std::uint8_t* out);
    /// Rounded means of 2x2 pixels: `count` of them from two rows.
    void (*halve)(const std::uint8_t* upper, const std::uint8_t* lower, int count, std::uint8_t* out);
    /// Moves edge pixels to the ridge of the magnitude: the vertex of the parabola through its logarithms
    /// before, at and after each pixel along its gradient, which is not zero there. No pixel is in the
    /// outermost row or column.
    /// @param pixel  indices y * width + x
    void (*refine)(const GradientView& gradient, const std::int32_t* pixel, std::size_t count,
                   const EdgePointArrays& out);
    /// Unit normals to `count` chords (u, v) on the side of the gradients, which are taken where the chord
    /// has no length, Eqs. (4)-(6). Any of the arrays may be an output.
    void (*normals)(const float* u, const float* v, const float* gradient_x, const float* gradient_y,
                    std::size_t count, float* nx, float* ny);
    /// Of each of `count` queries the nearest point within `radius` px of (u, v) with
    /// nx normal_x + ny normal_y >= min_cosine, the first of those as near; -1 where there is none.
    /// Coordinates are within 1e6 px.
    void (*nearestPoints)(const EdgeCells& cells, const float* u, const float* v, const float* nx,
                          const float* ny, std::size_t count, float radius, float min_cosine,
                          std::int32_t* found);
    /// The nearest surface in a square, its plane (in inverse depth) evaluated at (u, v) from the centre, px.
    void (*depthPatch)(const DepthSquare& square, const DepthLimits& limits, float u, float v,
                       DepthPatch& out);
    /// Adds what the normal of an edge's point passes on one side to its sums.
    void (*side)(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& sums);
};

const Table& baseline();
const Table* avx2();  ///< nullptr where this processor lacks it
const Table& best();

}  // namespace roevo::pixels
