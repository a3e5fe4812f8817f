// Residuals, weights and information of both trackers; what lanes_impl.h says of itself holds here.

/// Depths to divide by: of what is not ahead of the camera, which counts for nothing, any.
inline Lanes ahead(Lanes z) {
    return z > 1e-3F ? z : Lanes{} + 1;
}

/// A member of eight neighbouring structures of floats, the first of which is at `first`.
template <int kFloats>
inline Lanes member(const float* first) {
    return pickLanes(first, kFloats * kLane);
}

constexpr int kResidualFloats = sizeof(PatchResidual) / sizeof(float);
constexpr int kPatchFloats = sizeof(Patch) / sizeof(float);

void weighPatches(const PatchResidual* residuals, const float* prior, std::size_t n, float inverse,
                  float* weight, Fit& fit) {
    Lanes weights{}, slopes{};
    for (std::size_t i = 0; i < n; i += kLanes) {
        const Lanes value = member<kResidualFloats>(&residuals[i].squared), squared = value * inverse;
        const Lanes w = value >= 0 ? load(prior + i) * (kStudentNu + 1) / (kStudentNu + squared) : Lanes{};
        store(weight + i, w);
        weights += w;
        slopes += w * ((kStudentNu - squared) / (kStudentNu + squared));
    }
    fit = {sumLanes(weights), sumLanes(slopes)};
}

/// Members of the patches of eight points; past the last one those of the last one.
struct PatchBlock {
    IntLanes index;
    const float* first;
    PatchBlock(const PatchPoints& points, std::size_t i)
        : first(reinterpret_cast<const float*>(points.patches)) {
        const auto last = static_cast<std::int32_t>(points.count) - 1;
        index = kLane + static_cast<std::int32_t>(i);
        index = (index < last ? index : IntLanes{} + last) * kPatchFloats;
    }
    Lanes operator()(std::size_t offset_of_member) const {
        return pickLanes(first + offset_of_member / sizeof(float), index);
    }
};

void sumPatches(const PatchPoints& p, std::size_t n, PatchSums& out) {
    Lanes weight{}, reference{}, squared{}, image{}, cross{};
    for (std::size_t i = 0; i < n; i += kLanes) {
        const Lanes w = load(p.weight + i);
        const PatchBlock patch(p, i);
        weight += w;
        reference += w * patch(__builtin_offsetof(Patch, sum));
        squared += w * patch(__builtin_offsetof(Patch, sum_squared));
        image += w * member<kResidualFloats>(&p.residuals[i].current);
        cross += w * member<kResidualFloats>(&p.residuals[i].cross);
    }
    out = {sumLanes(weight), sumLanes(reference), sumLanes(squared), sumLanes(image), sumLanes(cross)};
}

/// Writes points, and of their information the matrix (xx xy xz yy yz zz) and then the vector.
inline void storeInformation(const InformationArrays& out, std::size_t i, Lanes x, Lanes y, Lanes z,
                             const Lanes (&information)[9]) {
    store(out.x + i, x);
    store(out.y + i, y);
    store(out.z + i, z);
    for (int k = 0; k < 6; ++k) store(out.matrix[k] + i, information[k]);
    for (int k = 0; k < 3; ++k) store(out.vector[k] + i, information[6 + k]);
}

void liftPatches(const PatchPoints& p, std::size_t n, float fx, float fy, float scale, float gain,
                 const InformationArrays& out) {
    constexpr std::size_t kGram = __builtin_offsetof(Patch, gram);
    for (std::size_t i = 0; i < n; i += kLanes) {
        const PatchBlock patch(p, i);
        // From the aligned frame to the image: M = A G A^T, v = A g with A = [c -s; s c]
        // The current image's slopes are `gain` times the reference's: so is the Jacobian
        const Lanes c = load(p.axis_x + i), s = load(p.axis_y + i);
        const Lanes slopes = load(p.weight + i) * scale * gain, squares = slopes * gain;
        const Lanes g0 = patch(kGram) * squares, g1 = patch(kGram + sizeof(float)) * squares,
                    g2 = patch(kGram + 2 * sizeof(float)) * squares;
        const Lanes r0 = member<kResidualFloats>(&p.residuals[i].gradient_u) * slopes,
                    r1 = member<kResidualFloats>(&p.residuals[i].gradient_v) * slopes;
        const Lanes m00 = c * c * g0 - 2 * c * s * g1 + s * s * g2;
        const Lanes m01 = c * s * (g0 - g2) + (c * c - s * s) * g1;
        const Lanes m11 = s * s * g0 + 2 * c * s * g1 + c * c * g2;
        const Lanes v0 = c * r0 - s * r1, v1 = s * r0 + c * r1;
        // P^T M P and P^T v of the projection P = [a 0 e; 0 b d], Eq. (24)
        const Lanes x = load(p.x + i), y = load(p.y + i), z = load(p.z + i);
        const Lanes inverse = 1 / ahead(z), a = fx * inverse, b = fy * inverse, e = -a * x * inverse,
                    d = -b * y * inverse;
        const Lanes t0 = m00 * e + m01 * d, t1 = m01 * e + m11 * d;
        storeInformation(out, i, x, y, z,
                         {a * a * m00, a * b * m01, a * t0, b * b * m11, b * t1, e * t0 + d * t1, a * v0,
                          b * v1, e * v0 + d * v1});
    }
}

void pick(const float* values, const std::int32_t* index, std::size_t n, float* out) {
    for (std::size_t i = 0; i < n; i += kLanes) store(out + i, pickLanes(values, load<IntLanes>(index + i)));
}

void follow(const float* u, const float* v, const ImageEdges& edges, std::size_t n, std::int32_t* current) {
    for (std::size_t i = 0; i < n; i += kLanes) {
        const Lanes at_u = load(u + i), at_v = load(v + i);
        const auto squaredTo = [&](IntLanes p) {
            const Lanes du = pickLanes(edges.x, p) - at_u, dv = pickLanes(edges.y, p) - at_v;
            return du * du + dv * dv;
        };
        IntLanes p = load<IntLanes>(current + i);
        const IntLanes edge = pickLanes(edges.edge_of, p);
        const IntLanes first = pickLanes(edges.begin, edge), last = pickLanes(edges.begin + 1, edge) - 1;
        const Lanes here = squaredTo(p);
        Lanes nearest = here;
        const auto walk = [&](IntLanes moving, IntLanes end, int step) {
            for (;;) {
                moving &= p != end;
                const IntLanes next = moving ? p + step : p;
                const Lanes squared = squaredTo(next);
                moving &= squared < nearest;
                if (!any(moving)) return;
                p = moving ? next : p;
                nearest = moving ? squared : nearest;
            }
        };
        walk(IntLanes{} - 1, last, 1);
        walk(nearest == here, first, -1);
        store(current + i, p);
    }
}

inline Lanes blurOf(const CameraMotion& m, Lanes x, Lanes y, Lanes z, Lanes nx, Lanes ny) {
    const Lanes inverse = 1 / ahead(z), a = x * inverse, b = y * inverse;
    const Lanes towards = m.velocity[2] * inverse + m.turn[0] * b - m.turn[1] * a;
    const Lanes u = m.velocity[0] * inverse + m.turn[1] - m.turn[2] * b - a * towards;
    const Lanes v = m.velocity[1] * inverse + m.turn[2] * a - m.turn[0] - b * towards;
    const Lanes sigmas = m.to_sigmas_x * nx * u + m.to_sigmas_y * ny * v;
    return sigmas * sigmas;
}

void blur(const CameraMotion& motion, const float* x, const float* y, const float* z, const float* nx,
          const float* ny, std::size_t n, float* out) {
    for (std::size_t i = 0; i < n; i += kLanes)
        store(out + i, blurOf(motion, load(x + i), load(y + i), load(z + i), load(nx + i), load(ny + i)));
}

void edgeResiduals(const MatchedPoints& m, const ImageEdges& edges, const CameraMotion& motion,
                   const float* keyframe_blur, std::size_t n, float* residual, float* sharpness,
                   float* magnitude) {
    for (std::size_t i = 0; i < n; i += kLanes) {
        const IntLanes p = load<IntLanes>(m.current + i);
        const Lanes nx = pickLanes(edges.normal_x, p), ny = pickLanes(edges.normal_y, p);
        // Eq. (7), as a signed scalar across the tangent (its square and normal equations are the same),
        // about the associated point rather than its predecessor: unbiased where the edge is curved
        const Lanes r =
            nx * (load(m.u + i) - pickLanes(edges.x, p)) + ny * (load(m.v + i) - pickLanes(edges.y, p));
        const Lanes now = blurOf(motion, load(m.x + i), load(m.y + i), load(m.z + i), nx, ny);
        const Lanes share = 1 / (1 + (now + load(keyframe_blur + i)));
        store(residual + i, r);
        store(sharpness + i, share);
        store(magnitude + i, magnitudeOf(r) * squareRoot(share));
    }
}

int weighEdges(const float* residual, const float* sharpness, const float* prior, std::size_t n,
               float inverse, float chi2, float* weight, Fit& fit) {
    Lanes weights{}, slopes{};
    IntLanes inliers{};
    for (std::size_t i = 0; i < n; i += kLanes) {
        const Lanes information = load(sharpness + i) * inverse, r = load(residual + i), w = load(prior + i);
        const Lanes squared = r * r * information;
        const IntLanes fits = (squared <= chi2) & (w > 0);
        const Lanes robust = fits ? w * information * (kStudentNu + 1) / (kStudentNu + squared) : Lanes{};
        store(weight + i, robust);
        weights += robust;
        slopes += fits ? robust * ((kStudentNu - squared) / (kStudentNu + squared)) : Lanes{};
        inliers -= fits;
    }
    fit = {sumLanes(weights), sumLanes(slopes)};
    int sum = 0;
    for (int l = 0; l < kLanes; ++l) sum += inliers[l];
    return sum;
}

/// Derivative of a tangent residual by the point, Eq. (24).
struct ByPoint {
    Lanes x, y, z;  ///< of the point
    Lanes j0, j1, j2;
    ByPoint(const MatchedPoints& m, const ImageEdges& edges, std::size_t i, float fx, float fy)
        : x(load(m.x + i)), y(load(m.y + i)), z(load(m.z + i)) {
        const IntLanes p = load<IntLanes>(m.current + i);
        const Lanes inverse = 1 / ahead(z);
        j0 = fx * inverse * pickLanes(edges.normal_x, p);
        j1 = fy * inverse * pickLanes(edges.normal_y, p);
        j2 = -(j0 * x + j1 * y) * inverse;
    }
};

/// Writes the point, the information w j j^T of a residual with derivative j by it, and the vector w r j.
inline void storeRank1(const InformationArrays& out, std::size_t i, Lanes w, Lanes r, const ByPoint& by) {
    const Lanes w0 = w * by.j0, w1 = w * by.j1, w2 = w * by.j2;
    storeInformation(
        out, i, by.x, by.y, by.z,
        {w0 * by.j0, w0 * by.j1, w0 * by.j2, w1 * by.j1, w1 * by.j2, w2 * by.j2, w0 * r, w1 * r, w2 * r});
}

void liftEdges(const MatchedPoints& m, const ImageEdges& edges, const float* weight, const float* residual,
               const float* depth_weight, const float* depth_residual, std::size_t n, float fx, float fy,
               const InformationArrays& out) {
    for (std::size_t i = 0; i < n; i += kLanes) {
        const ByPoint by(m, edges, i, fx, fy);
        const Lanes w = load(weight + i), r = load(residual + i);
        storeRank1(out, i, w, r, by);
        // Depths of outliers do not count either
        const Lanes depth = w > 0 ? load(depth_weight + i) : Lanes{};
        store(out.matrix[5] + i, w * by.j2 * by.j2 + depth);
        store(out.vector[2] + i, w * by.j2 * r + depth * load(depth_residual + i));
    }
}

void liftReadout(const MatchedPoints& m, const ImageEdges& edges, const CameraMotion& motion,
                 const ReadoutPoints& readout, const float* weight, const float* residual, std::size_t n,
                 float fx, float fy, const InformationArrays& out, ReadoutSums& sums) {
    Lanes mixed[6] = {}, own{}, gradient{};
    for (std::size_t i = 0; i < n; i += kLanes) {
        const ByPoint by(m, edges, i, fx, fy);
        const Lanes w = load(weight + i), r = load(residual + i);
        storeRank1(out, i, w, r, by);
        // Later rows see the point where it has moved to since, in both images
        const Lanes now0 = motion.velocity[0] + motion.turn[1] * by.z - motion.turn[2] * by.y;
        const Lanes now1 = motion.velocity[1] + motion.turn[2] * by.x - motion.turn[0] * by.z;
        const Lanes now2 = motion.velocity[2] + motion.turn[0] * by.y - motion.turn[1] * by.x;
        const Lanes x = load(readout.x + i), y = load(readout.y + i), z = load(readout.z + i);
        const float* t = readout.turn;
        const Lanes then0 = readout.velocity[0] + t[0] * x + t[1] * y + t[2] * z;
        const Lanes then1 = readout.velocity[1] + t[3] * x + t[4] * y + t[5] * z;
        const Lanes then2 = readout.velocity[2] + t[6] * x + t[7] * y + t[8] * z;
        const Lanes rows_now = load(m.v + i) - readout.reference_row;
        const Lanes rows_then = load(readout.row + i) - readout.reference_row;
        const Lanes by_readout = (by.j0 * then0 + by.j1 * then1 + by.j2 * then2) * rows_then -
                                 (by.j0 * now0 + by.j1 * now1 + by.j2 * now2) * rows_now;
        const Lanes wb = w * by_readout, m0 = wb * by.j0, m1 = wb * by.j1, m2 = wb * by.j2;
        mixed[0] += m0;
        mixed[1] += m1;
        mixed[2] += m2;
        mixed[3] += by.y * m2 - by.z * m1;
        mixed[4] += by.z * m0 - by.x * m2;
        mixed[5] += by.x * m1 - by.y * m0;
        own += wb * by_readout;
        gradient += wb * r;
    }
    for (int k = 0; k < 6; ++k) sums.mixed[k] = sumLanes(mixed[k]);
    sums.own = sumLanes(own);
    sums.gradient = sumLanes(gradient);
}
