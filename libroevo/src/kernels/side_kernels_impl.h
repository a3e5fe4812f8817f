// The surface on one side of an edge's point; what lanes_impl.h says of itself holds here.

inline Lanes floorOf(Lanes v) {
    const Lanes whole = __builtin_convertvector(__builtin_convertvector(v, IntLanes), Lanes);
    return whole > v ? whole - 1 : whole;
}

/// 0 where the condition is false.
template <class Vector>
inline Vector only(IntLanes condition, Vector v) {
    return (Vector)((IntLanes)v & condition);
}

/// Four columns (or rows) at once, from the outermost one inwards, of each the two pixels next to the normal.
/// Positions are relative to the point, so that they are as exact at the end of a wide image as at its
/// beginning.
template <bool kWidens>
void sumSide(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& sums) {
    constexpr IntLanes kColumn = {0, 0, 1, 1, 2, 2, 3, 3}, kRow = {0, 1, 0, 1, 0, 1, 0, 1};
    const bool by_column = reach.by_column;
    const double at_main = by_column ? at.x : at.y, at_other = by_column ? at.y : at.x;
    const auto n_main = static_cast<float>(by_column ? at.normal_x : at.normal_y),
               n_other = static_cast<float>(by_column ? at.normal_y : at.normal_x);
    const float slope = n_other / n_main;
    const int stride = static_cast<int>(depth.stride), width = depth.width, height = depth.height;
    const int along = by_column ? 1 : stride, across = by_column ? stride : 1;
    const int size = by_column ? width : height, other_size = by_column ? height : width;
    const int direction = reach.along == (n_main > 0) ? 1 : -1;
    const auto outwards = static_cast<float>(reach.along ? 1 : -1);
    const int whole = static_cast<int>(at_other);
    const auto offset = static_cast<float>(reach.centre - at_main),
               fraction = static_cast<float>(at_other - whole), clear = static_cast<float>(reach.clear);
    const float z = at.depth, step = reach.jump * z;
    Lanes sum[kLanes] = {};
    for (int outermost = reach.steps; outermost > 0; outermost -= 4) {
        const IntLanes column = direction * (outermost - kColumn), i = reach.centre + column;
        const Lanes from = offset + __builtin_convertvector(column, Lanes);
        const Lanes j = fraction + from * slope, k = floorOf(j) + __builtin_convertvector(kRow, Lanes);
        const Lanes distance = outwards * (n_main * from + n_other * (k - fraction));
        const IntLanes other = whole + __builtin_convertvector(k, IntLanes);
        const IntLanes inside = (i >= 0) & (i < size) & (other >= 0) & (other < other_size);
        const Lanes there = pickLanes(depth.data, only(inside, i * along + other * across));
        const Lanes behind = there - z;
        const IntLanes counts = inside & (there > 0) & (there <= __FLT_MAX__) & (distance >= clear);
        Lanes most = splat(step);
        if constexpr (kWidens) most += distance * (step / static_cast<float>(reach.widening));
        const IntLanes own = counts & (magnitudeOf(behind) <= most);
        const Lanes weight = 1 - magnitudeOf(j - k);
        const Lanes w = only(own, weight), q = only(own, z / there - 1);
        const Lanes ws = w * distance, wq = w * q;
        const Lanes more[kLanes] = {w,
                                    ws,
                                    wq,
                                    ws * distance,
                                    ws * q,
                                    wq * q,
                                    only(counts, weight),
                                    only(counts & (behind > step), weight)};
        for (int l = 0; l < kLanes; ++l) sum[l] += more[l];
    }
    const Lanes totals = sumsOf(sum);
    double* const targets = &sums.count;
    static_assert(sizeof(SideSums) == kLanes * sizeof(double));
    for (int l = 0; l < kLanes; ++l) targets[l] += totals[l];
}

void side(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& sums) {
    (reach.widening > 0 ? sumSide<true> : sumSide<false>)(depth, at, reach, sums);
}
