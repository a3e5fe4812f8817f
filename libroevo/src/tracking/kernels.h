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

/// Rigid motion and ideal pinhole camera, single precision.
struct Projection {
    float rotation[9];     ///< row-major
    float translation[3];  ///< m
    float fx, fy, cx, cy;  ///< px
    /// Rolling shutter: how the camera moves while one row is read (m, rad; in its own frame), and the row
    /// that the motion refers to.
    float velocity[3], turn[3], reference_row;
    float last_row;  ///< height - 1, px: no row is later
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

struct PointInformation {
    const float *x, *y, *z;  ///< m
    const float* matrix[6];  ///< xx xy xz yy yz zz
    const float* vector[3];
};

struct Table {
    const char* name;
    /// n is a multiple of kLanes.
    void (*project)(const Projection& motion, const float* x, const float* y, const float* z, std::size_t n,
                    const ProjectedPoints& out);
    /// Bilinear samples of the patches at (u, v), rotated so that the aligned frame's first axis is (axis_x,
    /// axis_y).
    void (*patches)(const ImageView& image, const Patch* patches, const float* u, const float* v,
                    const float* axis_x, const float* axis_y, std::size_t n, float gain, float offset,
                    PatchResidual* out);
    void (*accumulate)(const PointInformation& points, std::size_t n, NormalEquations& out);
};

const Table& baseline();
const Table* avx2();  ///< nullptr where this processor lacks it
const Table& best();  ///< what the trackers use

}  // namespace roevo::kernels
