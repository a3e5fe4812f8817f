#pragma once
/// The hot loops, over the pixels of an image and over points, compiled twice (portable baseline, AVX2) and
/// chosen at run time. Both give the same bytes: the same operations on the same eight lanes, without
/// contraction. tests/ compares them with plain loops, those over points in double precision.

#include <cstddef>
#include <cstdint>

namespace roevo::kernels {

constexpr int kLanes = 8;      ///< points per block; all arrays of points are padded to a multiple of it
constexpr int kPatchSize = 8;  ///< pixels of a patch
inline constexpr float kStudentNu = 5;  ///< degrees of freedom of the t-distribution of residuals

constexpr std::size_t paddedSize(std::size_t n) {
    return (n + kLanes - 1) / kLanes * kLanes;
}

// ---- Pixels and edges of an image

constexpr int kMostRidges = 64;            ///< pixels that ridges() looks at together
constexpr int kFractionBits = 5;           ///< of a pixel, in Remap
constexpr int kRemapPadding = kLanes - 1;  ///< entries of a Remap that may be read past the last one

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
constexpr int kGridPadding = kLanes - 1;        ///< points that may be read past the last one

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

// ---- Points of a keyframe in an image

/// How a camera moves while one row is read (m, rad; in its own frame), and the row that points refer to.
struct RowSpeed {
    float velocity[3], turn[3], reference_row;
};

/// Rigid motion and ideal pinhole camera, single precision.
struct Projection {
    float rotation[9];     ///< row-major
    float translation[3];  ///< m
    float fx, fy, cx, cy;  ///< px
    RowSpeed rows;         ///< of a rolling shutter
    float last_row;        ///< height - 1, px: no row is later
};

/// Points moved into the camera and projected; u = v = -1e6 where z <= 1e-3 m.
struct ProjectedPoints {
    float *x, *y, *z;  ///< m
    float *u, *v;      ///< px
};

/// One grey image, 8 bits.
struct ImageView {
    const std::uint8_t* data;
    std::ptrdiff_t stride;  ///< bytes
    int width, height;
};

/// Reference patch of one point in the frame aligned with its gradient (first axis along it).
struct Patch {
    float intensity[kPatchSize];  ///< grey levels
    float slope_u[kPatchSize],
        slope_v[kPatchSize];  ///< image gradient in the aligned frame, grey levels per pixel
    float gram[3];            ///< sums over the patch of slope_u^2, slope_u slope_v, slope_v^2
    float sum, sum_squared;   ///< of intensity
};

/// What a patch looks like in the current image, with residual e_j = I_c,j - gain I_r,j - offset.
struct PatchResidual {
    float squared;                 ///< sum of e_j^2; negative when the patch leaves the image
    float gradient_u, gradient_v;  ///< sums of slope_u e_j, slope_v e_j (aligned frame)
    float current, cross;          ///< sums of I_c,j and I_c,j I_r,j, for gain and offset
};

/// Patch pixels relative to the point, in the aligned frame: a symmetric diamond of radius 2.
inline constexpr float kPatchU[kPatchSize] = {-2, 2, 0, 0, -1, 1, -1, 1};
inline constexpr float kPatchV[kPatchSize] = {0, 0, -2, 2, -1, -1, 1, 1};

/// Normal equations of points in three dimensions: each point has a symmetric information matrix (xx xy xz yy
/// yz zz) and an information vector about its own position, all in the camera's frame; the pose is perturbed
/// on the left, xi = (t, phi), so d point / d xi = [I, -point^].
struct NormalEquations {
    double hessian[21];  ///< upper triangle, row by row
    double gradient[6];
};

struct InformationArrays {
    float *x, *y, *z;  ///< m
    float* matrix[6];  ///< xx xy xz yy yz zz
    float* vector[3];
};

/// Photometric points at a pose.
struct PatchPoints {
    const Patch* patches;            ///< `count` of them
    const PatchResidual* residuals;  ///< padded with invisible ones
    std::size_t count;
    const float *x, *y, *z;        ///< in the camera, m; padded, as all that follow
    const float *axis_x, *axis_y;  ///< the aligned frame's first axis in the image
    const float* weight;           ///< 0 for none
};

/// Sums over patches, for gain and offset.
struct PatchSums {
    double weight, reference, reference_squared, image, cross;
};

/// Edge points of an image (see OrganizedEdges), px.
struct ImageEdges {
    const float *x, *y, *normal_x, *normal_y;
    const std::int32_t *edge_of, *begin;
};

/// Keyframe points, each matched with one of the image; padded, with any valid index.
struct MatchedPoints {
    const float *x, *y, *z;  ///< in the camera, m
    const float *u, *v;      ///< px
    const std::int32_t* current;
};

/// How a camera moves (m/s, rad/s; its own axes), and what a speed across an edge, as tan/s, makes of its
/// standard deviation at rest.
struct CameraMotion {
    float velocity[3], turn[3];
    float to_sigmas_x, to_sigmas_y;
};

/// Sums of weights, and of what meanSlope() takes.
struct Fit {
    double weights, slopes;
};

/// What the read-out time does to matched points: where they are in the keyframe, and how they move there
/// while a row is read, turned into the camera: -(velocity + turn point), m/s.
struct ReadoutPoints {
    const float *x, *y, *z;  ///< in the keyframe, m; padded
    const float* row;        ///< in the keyframe, px; padded
    float velocity[3], turn[9];
    float reference_row;
};

/// Sums over points that join the read-out time to the pose.
struct ReadoutSums {
    double mixed[6], own, gradient;
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

    /// n is a multiple of kLanes.
    void (*project)(const Projection& motion, const float* x, const float* y, const float* z, std::size_t n,
                    const ProjectedPoints& out);
    /// Moves points that `from` brought to its reference row to where `to` would have brought them; one that
    /// would come to the camera stays. Any n, nothing padded.
    void (*exchangeMotion)(const RowSpeed& from, const RowSpeed& to, const float* row, std::size_t n,
                           float* x, float* y, float* z);
    /// Bilinear samples of the patches at (u, v), rotated so that the aligned frame's first axis is (axis_x,
    /// axis_y).
    void (*patches)(const ImageView& image, const Patch* patches, const float* u, const float* v,
                    const float* axis_x, const float* axis_y, std::size_t n, float gain, float offset,
                    PatchResidual* out);
    /// The patch of a reference image at (u, v), at least 5 px from its border, in the frame whose first axis
    /// is (axis_x, axis_y).
    void (*referencePatch)(const ImageView& image, float u, float v, float axis_x, float axis_y, Patch& out);
    void (*accumulate)(const InformationArrays& points, std::size_t n, NormalEquations& out);

    // What follows takes n in whole blocks, too.

    /// Weights of the t-distribution: squared residuals times `inverse` are relative to their spread.
    /// @param prior  weight of each point before; 0 in the padding
    void (*weighPatches)(const PatchResidual* residuals, const float* prior, std::size_t n, float inverse,
                         float* weight, Fit& fit);
    void (*sumPatches)(const PatchPoints& points, std::size_t n, PatchSums& out);
    /// Information of the points times `scale`, where the image has `gain` times the reference's slopes.
    void (*liftPatches)(const PatchPoints& points, std::size_t n, float fx, float fy, float scale, float gain,
                        const InformationArrays& out);

    /// values[index[i]] for each i.
    void (*pick)(const float* values, const std::int32_t* index, std::size_t n, float* out);
    /// Moves edge points along their edges to where these are nearest to (u, v), as long as they come nearer:
    /// towards the end, or else towards the beginning.
    void (*follow)(const float* u, const float* v, const ImageEdges& edges, std::size_t n,
                   std::int32_t* current);
    /// Variances across edges that motion adds, relative to those at rest (see blurVariance()).
    void (*blur)(const CameraMotion& motion, const float* x, const float* y, const float* z, const float* nx,
                 const float* ny, std::size_t n, float* out);
    /// Point-to-tangent residuals (px), the information across each edge as a share of what it is at rest,
    /// and magnitudes in sigmas of that.
    /// @param keyframe_blur  variances that the motion of the keyframe adds
    void (*edgeResiduals)(const MatchedPoints& matches, const ImageEdges& edges, const CameraMotion& motion,
                          const float* keyframe_blur, std::size_t n, float* residual, float* sharpness,
                          float* magnitude);
    /// Weights of the t-distribution, 0 beyond `chi2`.
    /// @param inverse  one over the squared spread of residuals at rest
    /// @param prior    weight of each point before; 0 in the padding
    /// @return points within it
    int (*weighEdges)(const float* residual, const float* sharpness, const float* prior, std::size_t n,
                      float inverse, float chi2, float* weight, Fit& fit);
    /// Information of tangent residuals and of depths.
    void (*liftEdges)(const MatchedPoints& matches, const ImageEdges& edges, const float* weight,
                      const float* residual, const float* depth_weight, const float* depth_residual,
                      std::size_t n, float fx, float fy, const InformationArrays& out);
    /// The same without depths, and what joins the read-out time to the pose.
    void (*liftReadout)(const MatchedPoints& matches, const ImageEdges& edges, const CameraMotion& motion,
                        const ReadoutPoints& readout, const float* weight, const float* residual,
                        std::size_t n, float fx, float fy, const InformationArrays& out, ReadoutSums& sums);

    /// What a point that `n` keyframes see takes from their Hessian: of keyframes a <= c the block
    /// (slot[a], slot[c]) loses through_a coupling_c^T. Matrices are stored column by column.
    /// @param coupling, through  6x3, one of each keyframe after the other
    /// @param blocks             6x6, `num_slots` in a row
    void (*eliminatePoint)(const double* coupling, const double* through, const std::int32_t* slot, int n,
                           int num_slots, double* blocks);
};

const Table& baseline();
const Table* avx2();  ///< nullptr where this processor lacks it
const Table& best();  ///< what all use

}  // namespace roevo::kernels
