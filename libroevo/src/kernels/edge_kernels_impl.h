// Loops over the pixels and points of edges; what lanes_impl.h says of itself holds here.

/// Values at these indices.
inline IntLanes gather(const std::int16_t* data, IntLanes index) {
    IntLanes values;
    for (int l = 0; l < kLanes; ++l) values[l] = data[index[l]];
    return values;
}

/// Logarithm of (value + floor) / (here + floor), to 4e-6 of itself where value <= here <= 3 floor: twice the
/// inverse hyperbolic tangent.
inline Lanes logRatio(Lanes value, Lanes here, Lanes floor) {
    const Lanes s = (value - here) / (value + here + 2 * floor), t = s * s;
    const Lanes series =
        1.0000033881F + t * (0.3328929437F + t * (0.2089945288F + t * (0.0808183651F + t * 0.2705720870F)));
    return 2 * s * series;
}

void refine(const GradientView& g, const std::int32_t* pixel, std::size_t count, const EdgePointArrays& out) {
    const float rows_per_pixel = 1 / static_cast<float>(g.width);
    for (std::size_t i = 0; i < count; i += kLanes) {
        const std::size_t rest = count - i;
        const IntLanes p = loadSome<IntLanes>(pixel + i, rest);
        IntLanes row =
            __builtin_convertvector((__builtin_convertvector(p, Lanes) + 0.5F) * rows_per_pixel, IntLanes);
        IntLanes column = p - row * g.width;
        const IntLanes before = column < 0, beyond = column >= g.width;  // rounding; -1 where it is true
        row += before - beyond;
        column += (beyond - before) * g.width;
        const IntLanes gx = gather(g.gx, p), gy = gather(g.gy, p);
        const IntLanes by_column = (gx < 0 ? -gx : gx) >= (gy < 0 ? -gy : gy);
        // Magnitudes one step along the gradient, between the two neighbours that its line passes
        const Lanes large = __builtin_convertvector(by_column ? gx : gy, Lanes);
        const Lanes slope = __builtin_convertvector(by_column ? gy : gx, Lanes) / large;
        const Lanes share = magnitudeOf(slope);
        const IntLanes across = by_column ? IntLanes{} + g.width : IntLanes{} + 1;
        const IntLanes step = by_column ? IntLanes{} + 1 : IntLanes{} + g.width;
        const IntLanes side = slope >= 0 ? across : -across;
        const Lanes here = pickLanes(g.magnitude, p);
        const Lanes next = pickLanes(g.magnitude, p + step), last = pickLanes(g.magnitude, p - step);
        const Lanes after = next + share * (pickLanes(g.magnitude, p + step + side) - next);
        const Lanes ahead = last + share * (pickLanes(g.magnitude, p - step - side) - last);
        // A blurred step has a Gaussian ridge, whose logarithm is a parabola; the floor, because where a
        // sharp ridge ends the logarithm would run away
        const Lanes floor = 0.33F * here;
        const Lanes rise = logRatio(ahead, here, floor), fall = logRatio(after, here, floor);
        const IntLanes curved = rise + fall < 0;
        Lanes vertex = 0.5F * (rise - fall) / (curved ? rise + fall : Lanes{} - 1);
        vertex = vertex < -0.5F ? Lanes{} - 0.5F : vertex;
        vertex = vertex > 0.5F ? Lanes{} + 0.5F : vertex;
        vertex = curved ? vertex : Lanes{};
        const Lanes by_slope = vertex * slope;
        storeSome(out.x + i, __builtin_convertvector(column, Lanes) + (by_column ? vertex : by_slope), rest);
        storeSome(out.y + i, __builtin_convertvector(row, Lanes) + (by_column ? by_slope : vertex), rest);
        storeSome(out.gradient_x + i, __builtin_convertvector(gx, Lanes) / here, rest);
        storeSome(out.gradient_y + i, __builtin_convertvector(gy, Lanes) / here, rest);
        storeSome(out.strength + i, here / 8, rest);
    }
}

void normals(const float* u, const float* v, const float* gradient_x, const float* gradient_y,
             std::size_t count, float* nx, float* ny) {
    for (std::size_t i = 0; i < count; i += kLanes) {
        const std::size_t rest = count - i;
        const Lanes du = loadSome(u + i, rest), dv = loadSome(v + i, rest);
        const Lanes gx = loadSome(gradient_x + i, rest), gy = loadSome(gradient_y + i, rest);
        const Lanes length = squareRoot(du * du + dv * dv);
        const IntLanes known = length > 0;
        const Lanes x = -dv / length, y = du / length;  // Eq. (4)
        const IntLanes wrong = x * gx + y * gy < 0;     // Eqs. (5), (6)
        storeSome(nx + i, known ? (wrong ? -x : x) : gx, rest);
        storeSome(ny + i, known ? (wrong ? -y : y) : gy, rest);
    }
}

inline Lanes lesserOf(Lanes a, Lanes b) {
    return a < b ? a : b;
}

inline Lanes greaterOf(Lanes a, Lanes b) {
    return a > b ? a : b;
}

/// What `choose` leaves of all lanes, in each.
template <class Vector, class Choose>
inline Vector reduce(Vector v, const Choose& choose) {
    v = choose(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
    v = choose(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
    return choose(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
}

/// The cell that a coordinate is in, or the outermost one.
inline int cellOf(float at, float per_pixel, int count) {
    const int cell = static_cast<int>(at * per_pixel);
    return cell < 0 ? 0 : cell < count ? cell : count - 1;
}

void nearestPoints(const EdgeCells& cells, const float* u, const float* v, const float* nx, const float* ny,
                   std::size_t count, float radius, float min_cosine, std::int32_t* found) {
    constexpr float kColumns = 1.0F / kCellWidth, kRows = 1.0F / kCellHeight;
    for (std::size_t i = 0; i < count; ++i) {
        const int left = cellOf(u[i] - radius, kColumns, cells.columns),
                  right = cellOf(u[i] + radius, kColumns, cells.columns),
                  bottom = cellOf(v[i] + radius, kRows, cells.rows);
        Lanes nearest = splat(radius * radius);
        IntLanes best = IntLanes{} - 1;
        for (int row = cellOf(v[i] - radius, kRows, cells.rows); row <= bottom; ++row) {
            const std::int32_t* first = cells.first + row * cells.columns;
            const std::int32_t end = first[right + 1];
            // What is read beyond the end are points as good as any
            for (std::int32_t k = first[left]; k < end; k += kLanes) {
                const Lanes du = load(cells.x + k) - u[i], dv = load(cells.y + k) - v[i];
                const Lanes squared = du * du + dv * dv;
                const Lanes cosine = load(cells.normal_x + k) * nx[i] + load(cells.normal_y + k) * ny[i];
                const IntLanes better = (squared < nearest) & (cosine >= splat(min_cosine));
                nearest = better ? squared : nearest;
                best = better ? kLane + k : best;
            }
        }
        const Lanes least = reduce(nearest, lesserOf);
        const std::int32_t point = reduce(nearest == least ? best : IntLanes{} + INT32_MAX,
                                          [](IntLanes a, IntLanes b) { return a < b ? a : b; })[0];
        found[i] = point < 0 ? -1 : cells.index[point];
    }
}

/// Where the least-squares plane of inverse depths is at (u, v), or their mean where they span none.
inline float planeAt(float u, float v, float n, Lanes sums) {
    const float sx = sums[0], sy = sums[1], sxx = sums[2], sxy = sums[3], syy = sums[4], sq = sums[5],
                sxq = sums[6], syq = sums[7];
    const float mx = sx / n, my = sy / n, mq = sq / n;
    const float xx = sxx - sx * mx, xy = sxy - sx * my, yy = syy - sy * my;
    const float xq = sxq - sx * mq, yq = syq - sy * mq;
    const float determinant = xx * yy - xy * xy;
    if (n < 6 || determinant < 0.05F * n * n) return mq;
    const float b = (xq * yy - yq * xy) / determinant, c = (yq * xx - xq * xy) / determinant;
    return mq + b * (u - mx) + c * (v - my);
}

/// The farthest of the depths that follow each other within the jump from the nearest one on.
inline float endOfSurface(const Lanes* rows, int count, float nearest, float jump) {
    for (float end = nearest;; nearest = end) {
        Lanes farthest = splat(nearest);
        const float limit = nearest * jump;
        for (int r = 0; r < count; ++r) farthest = greaterOf(rows[r] <= limit ? rows[r] : Lanes{}, farthest);
        end = reduce(farthest, greaterOf)[0];
        if (end == nearest) return end;
    }
}

inline float leastBeyond(const Lanes* rows, int count, float limit) {
    Lanes least = splat(__FLT_MAX__);
    for (int r = 0; r < count; ++r) least = lesserOf(rows[r] > limit ? rows[r] : splat(__FLT_MAX__), least);
    return reduce(least, lesserOf)[0];
}

inline int countWithin(const Lanes* rows, int count, float least, float most) {
    IntLanes found{};
    for (int r = 0; r < count; ++r) found -= (rows[r] >= least) & (rows[r] <= most);
    return static_cast<int>(sumLanes(__builtin_convertvector(found, Lanes)));
}

void depthPatch(const DepthSquare& square, const DepthLimits& limits, float u, float v, DepthPatch& out) {
    const int size = square.size;
    const IntLanes inside = kLane < size;
    Lanes nearest = splat(__FLT_MAX__), farthest{}, rows[kMostPatch];
    for (int r = 0; r < size; ++r) {
        const Lanes z = load(square.depth + r * square.stride);
        const IntLanes known = inside & (z >= limits.near) & (z <= limits.far);
        rows[r] = known ? z : Lanes{};
        nearest = lesserOf(known ? z : splat(__FLT_MAX__), nearest);
        farthest = greaterOf(rows[r], farthest);
    }
    out = {0, reduce(nearest, lesserOf)[0], reduce(farthest, greaterOf)[0], 0};
    const float last = out.farthest;
    do {  // from the nearest depth on, those that follow each other within the jump
        if (out.nearest > last) return;
        const bool one_surface = last <= out.nearest * limits.jump;
        out.farthest = one_surface ? last : endOfSurface(rows, size, out.nearest, limits.jump);
        out.count = countWithin(rows, size, out.nearest, out.farthest);
        if (out.count >= limits.least) break;
        out.count = 0;  // speckle in front of everything else
        out.nearest = leastBeyond(rows, size, out.farthest);
    } while (true);
    // Sums of columns first; inverse depths relative to the nearest one, which keeps them small
    const float base = 1 / out.nearest;
    const Lanes x = load(square.columns);
    Lanes count{}, y1{}, y2{}, q{}, yq{};
    for (int r = 0; r < size; ++r) {
        const float y = square.rows[r];
        const IntLanes own = (rows[r] >= out.nearest) & (rows[r] <= out.farthest);
        const Lanes inverse = own ? 1 / rows[r] - base : Lanes{};
        count += own ? splat(1) : Lanes{};
        y1 += own ? splat(y) : Lanes{};
        y2 += own ? splat(y * y) : Lanes{};
        q += inverse;
        yq += y * inverse;
    }
    const Lanes products[kLanes] = {x * count, y1, x * x * count, x * y1, y2, q, x * q, yq};
    out.inverse = base + planeAt(u, v, static_cast<float>(out.count), sumsOf(products));
}
