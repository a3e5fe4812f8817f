// Included by one file per instruction set, inside an anonymous namespace; what lanes_impl.h says of itself
// holds here.

void project(const Projection& m, const float* px, const float* py, const float* pz, std::size_t n,
             const ProjectedPoints& out) {
    const Lanes behind = splat(-1e6F), least = splat(1e-3F), one = splat(1);
    for (std::size_t i = 0; i < n; i += kLanes) {
        const Lanes x = load(px + i), y = load(py + i), z = load(pz + i);
        Lanes cx = m.rotation[0] * x + m.rotation[1] * y + m.rotation[2] * z + m.translation[0];
        Lanes cy = m.rotation[3] * x + m.rotation[4] * y + m.rotation[5] * z + m.translation[1];
        Lanes cz = m.rotation[6] * x + m.rotation[7] * y + m.rotation[8] * z + m.translation[2];
        // The row on which the point is seen says when it was seen, and so where the camera was by then
        const IntLanes ahead = cz > least;
        Lanes row = m.fy * cy / (ahead ? cz : one) + m.cy;
        row = row > splat(0) ? row : splat(0);
        row = row < splat(m.last_row) ? row : splat(m.last_row);
        const Lanes rows = row - m.rows.reference_row;
        const Lanes dx = m.rows.velocity[0] + m.rows.turn[1] * cz - m.rows.turn[2] * cy;
        const Lanes dy = m.rows.velocity[1] + m.rows.turn[2] * cx - m.rows.turn[0] * cz;
        const Lanes dz = m.rows.velocity[2] + m.rows.turn[0] * cy - m.rows.turn[1] * cx;
        cx -= rows * dx;
        cy -= rows * dy;
        cz -= rows * dz;
        const IntLanes in_front = ahead & (cz > least);
        const Lanes inverse = one / (in_front ? cz : one);
        store(out.x + i, cx);
        store(out.y + i, cy);
        store(out.z + i, cz);
        store(out.u + i, in_front ? m.fx * cx * inverse + m.cx : behind);
        store(out.v + i, in_front ? m.fy * cy * inverse + m.cy : behind);
    }
}

void exchangeMotion(const RowSpeed& from, const RowSpeed& to, const float* row, std::size_t n, float* px,
                    float* py, float* pz) {
    constexpr float kNearest = 0.05F;  // m
    for (std::size_t i = 0; i < n; i += kLanes) {
        const std::size_t rest = n - i;
        const Lanes x = loadSome(px + i, rest), y = loadSome(py + i, rest), z = loadSome(pz + i, rest);
        const Lanes rows = loadSome(row + i, rest), a = rows - from.reference_row,
                    b = rows - to.reference_row;
        const Lanes t0 = b * to.turn[0] - a * from.turn[0], t1 = b * to.turn[1] - a * from.turn[1],
                    t2 = b * to.turn[2] - a * from.turn[2];
        const Lanes moved_x = x + (b * to.velocity[0] - a * from.velocity[0]) + (t1 * z - t2 * y);
        const Lanes moved_y = y + (b * to.velocity[1] - a * from.velocity[1]) + (t2 * x - t0 * z);
        const Lanes moved_z = z + (b * to.velocity[2] - a * from.velocity[2]) + (t0 * y - t1 * x);
        const IntLanes moves = moved_z > splat(kNearest);
        storeSome(px + i, moves ? moved_x : x, rest);
        storeSome(py + i, moves ? moved_y : y, rest);
        storeSome(pz + i, moves ? moved_z : z, rest);
    }
}

/// Bilinear samples.
inline Lanes bilinear(const ImageView& image, Lanes x, Lanes y) {
    const auto stride = static_cast<std::int32_t>(image.stride);
    const IntLanes ix = __builtin_convertvector(x, IntLanes), iy = __builtin_convertvector(y, IntLanes);
    const Lanes fx = x - __builtin_convertvector(ix, Lanes), fy = y - __builtin_convertvector(iy, Lanes);
    const IntLanes index = iy * stride + ix;
    const IntLanes upper = gather(image.data, index), lower = gather(image.data + stride, index);
    const Lanes i00 = __builtin_convertvector(upper & 255, Lanes);
    const Lanes i01 = __builtin_convertvector((upper >> 8) & 255, Lanes);
    const Lanes i10 = __builtin_convertvector(lower & 255, Lanes);
    const Lanes i11 = __builtin_convertvector((lower >> 8) & 255, Lanes);
    const Lanes top = i00 + fx * (i01 - i00), bottom = i10 + fx * (i11 - i10);
    return top + fy * (bottom - top);
}

/// Products of the pixels of eight patches, before they are summed.
struct PatchProducts {
    Lanes squared[kLanes], gradient_u[kLanes], gradient_v[kLanes], current[kLanes], cross[kLanes];
};

/// Samples a patch around (u, v), which lies inside.
inline void samplePatch(const ImageView& image, const Patch& patch, float u, float v, float axis_x,
                        float axis_y, float gain, float offset, int k, PatchProducts& out) {
    const Lanes du = load(kPatchU), dv = load(kPatchV);
    const Lanes current = bilinear(image, u + axis_x * du - axis_y * dv, v + axis_y * du + axis_x * dv);
    const Lanes reference = load(patch.intensity);
    const Lanes e = current - gain * reference - offset;
    out.squared[k] = e * e;
    out.gradient_u[k] = load(patch.slope_u) * e;
    out.gradient_v[k] = load(patch.slope_v) * e;
    out.current[k] = current;
    out.cross[k] = current * reference;
}

void referencePatch(const ImageView& image, float u, float v, float axis_x, float axis_y, Patch& out) {
    const Lanes du = load(kPatchU), dv = load(kPatchV);
    const Lanes x = u + axis_x * du - axis_y * dv, y = v + axis_y * du + axis_x * dv;
    const Lanes along =
        (bilinear(image, x + axis_x, y + axis_y) - bilinear(image, x - axis_x, y - axis_y)) / 2;
    const Lanes across =
        (bilinear(image, x - axis_y, y + axis_x) - bilinear(image, x + axis_y, y - axis_x)) / 2;
    const Lanes intensity = bilinear(image, x, y);
    store(out.intensity, intensity);
    store(out.slope_u, along);
    store(out.slope_v, across);
    out.gram[0] = sumLanes(along * along);
    out.gram[1] = sumLanes(along * across);
    out.gram[2] = sumLanes(across * across);
    out.sum = sumLanes(intensity);
    out.sum_squared = sumLanes(intensity * intensity);
}

void patches(const ImageView& image, const Patch* patch, const float* u, const float* v, const float* axis_x,
             const float* axis_y, std::size_t n, float gain, float offset, PatchResidual* out) {
    constexpr float kReach = 4;  // the patch, its bilinear neighbours, and whole words when gathering
    const float max_u = static_cast<float>(image.width - 1) - kReach;
    const float max_v = static_cast<float>(image.height - 1) - kReach;
    PatchProducts products = {};
    for (std::size_t begin = 0; begin < n; begin += kLanes) {
        const int count = n - begin < kLanes ? static_cast<int>(n - begin) : kLanes;
        unsigned inside = 0;
        for (int k = 0; k < count; ++k) {
            const std::size_t i = begin + static_cast<std::size_t>(k);
            if (!(u[i] >= kReach && u[i] <= max_u && v[i] >= kReach && v[i] <= max_v)) continue;
            inside |= 1U << k;
            samplePatch(image, patch[i], u[i], v[i], axis_x[i], axis_y[i], gain, offset, k, products);
        }
        if (inside == 0) {
            for (int k = 0; k < count; ++k) out[begin + static_cast<std::size_t>(k)] = {-1, 0, 0, 0, 0};
            continue;
        }
        const Lanes squared = sumsOf(products.squared), gradient_u = sumsOf(products.gradient_u),
                    gradient_v = sumsOf(products.gradient_v), current = sumsOf(products.current),
                    cross = sumsOf(products.cross);
        for (int k = 0; k < count; ++k) {
            PatchResidual& residual = out[begin + static_cast<std::size_t>(k)];
            residual = {-1, 0, 0, 0, 0};
            if ((inside >> k & 1) != 0)
                residual = {squared[k], gradient_u[k], gradient_v[k], current[k], cross[k]};
        }
    }
}

void accumulate(const InformationArrays& p, std::size_t n, NormalEquations& out) {
    out = {};
    constexpr std::size_t kChunk = 256;  // summed in single precision, chunks in double
    for (std::size_t begin = 0; begin < n; begin += kChunk) {
        const std::size_t end = begin + kChunk < n ? begin + kChunk : n;
        Lanes sums[27] = {};
        for (std::size_t i = begin; i < end; i += kLanes) {
            const Lanes x = load(p.x + i), y = load(p.y + i), z = load(p.z + i);
            const Lanes xx = load(p.matrix[0] + i), xy = load(p.matrix[1] + i), xz = load(p.matrix[2] + i);
            const Lanes yy = load(p.matrix[3] + i), yz = load(p.matrix[4] + i), zz = load(p.matrix[5] + i);
            const Lanes vx = load(p.vector[0] + i), vy = load(p.vector[1] + i), vz = load(p.vector[2] + i);
            // A = M (-point^), with -point^ = [0 z -y; -z 0 x; y -x 0]
            const Lanes a00 = y * xz - z * xy, a01 = z * xx - x * xz, a02 = x * xy - y * xx;
            const Lanes a10 = y * yz - z * yy, a11 = z * xy - x * yz, a12 = x * yy - y * xy;
            const Lanes a20 = y * zz - z * yz, a21 = z * xz - x * zz, a22 = x * yz - y * xz;
            // B = (-point^)^T A, rows (0 -z y), (z 0 -x), (-y x 0)
            const Lanes b00 = y * a20 - z * a10, b01 = y * a21 - z * a11, b02 = y * a22 - z * a12;
            const Lanes b11 = z * a01 - x * a21, b12 = z * a02 - x * a22, b22 = x * a12 - y * a02;
            const Lanes wx = y * vz - z * vy, wy = z * vx - x * vz, wz = x * vy - y * vx;
            const Lanes terms[27] = {xx,  xy,  xz,  a00, a01, a02, yy,  yz, a10, a11, a12, zz, a20, a21,
                                     a22, b00, b01, b02, b11, b12, b22, vx, vy,  vz,  wx,  wy, wz};
#pragma GCC unroll 27  // else the terms go through memory
            for (int k = 0; k < 27; ++k) sums[k] += terms[k];
        }
        for (int k = 0; k < 21; ++k) out.hessian[k] += sumLanes(sums[k]);
        for (int k = 0; k < 6; ++k) out.gradient[k] += sumLanes(sums[21 + k]);
    }
}
