#pragma once
/// The hot loops of both trackers, compiled twice (portable baseline, AVX2) and chosen at run time. Both give
/// the same bytes: the same operations on the same eight lanes, without contraction. tests/ compares them
/// with plain double-precision loops.

#include <cstddef>
#include <cstdint>

namespace roevo::kernels {

constexpr int kLanes = 8;      ///< points per block; all arrays of points are padded to a multiple of it
constexpr int kPatchSize = 8;  ///< pixels of a patch

constexpr std::size_t paddedSize(std::size_t n) {
    return (n + kLanes - 1) / kLanes * kLanes;
}

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
    /// Variances across edges that motion adds, relative to those at rest (see MotionBlur).
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
const Table& best();  ///< what the trackers use

}  // namespace roevo::kernels
