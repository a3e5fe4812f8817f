// The surfaces on both sides of an edge's point; what pixel_kernels_impl.h says of itself holds here.
#include "edge_kernels_impl.h"

// Four samples: two columns (or rows) of two pixels, in the order in which they are summed. Intrinsics where
// the compiler's conversions are slow.
typedef double FourDoubles __attribute__((vector_size(32)));
typedef std::int64_t FourLongs __attribute__((vector_size(32)));
typedef float FourFloats __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

/// values[index], of whole numbers.
inline FourFloats pickFour(const float* values, FourDoubles index) {
#ifdef __AVX2__
    return (FourFloats)_mm_i32gather_ps(values, _mm256_cvttpd_epi32((__m256d)index), 4);
#else
    const FourInts i = __builtin_convertvector(index, FourInts);
    return FourFloats{values[i[0]], values[i[1]], values[i[2]], values[i[3]]};
#endif
}

inline FourDoubles floorOf(FourDoubles v) {
#ifdef __AVX2__
    return (FourDoubles)_mm256_floor_pd((__m256d)v);
#else
    const FourDoubles whole = __builtin_convertvector(__builtin_convertvector(v, FourInts), FourDoubles);
    return whole > v ? whole - 1 : whole;
#endif
}

inline FourDoubles asDoubles(FourFloats v) {
#ifdef __AVX2__
    return (FourDoubles)_mm256_cvtps_pd((__m128)v);
#else
    return __builtin_convertvector(v, FourDoubles);
#endif
}

inline FourFloats asFloats(FourDoubles v) {
#ifdef __AVX2__
    return (FourFloats)_mm256_cvtpd_ps((__m256d)v);
#else
    return __builtin_convertvector(v, FourFloats);
#endif
}

/// One bit for each lane that is true.
inline unsigned laneBits(FourLongs condition) {
#ifdef __AVX2__
    return static_cast<unsigned>(_mm256_movemask_pd((__m256d)condition));
#else
    unsigned bits = 0;
    for (int l = 0; l < 4; ++l) bits |= static_cast<unsigned>(condition[l] & 1) << l;
    return bits;
#endif
}

/// 0 where the condition is false.
inline FourDoubles only(FourLongs condition, FourDoubles v) {
    return (FourDoubles)((FourLongs)v & condition);
}

inline FourDoubles magnitudeOf(FourDoubles v) {
    return (FourDoubles)((FourLongs)v & INT64_MAX);
}

/// Sums in the order of SideSums.
static_assert(sizeof(SideSums) == 2 * sizeof(FourDoubles));
struct SideAccumulator {
    FourDoubles first, last;
    explicit SideAccumulator(const SideSums& sums)
        : first(load<FourDoubles>(&sums.count)), last(load<FourDoubles>(&sums.sq)) {}
    void storeTo(SideSums& sums) const {
        store(&sums.count, first);
        store(&sums.sq, last);
    }
};

/// Rows become columns.
inline void transpose(FourDoubles a, FourDoubles b, FourDoubles c, FourDoubles d, FourDoubles* out) {
    const FourDoubles ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                      ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                      cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                      cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    out[0] = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
    out[2] = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
    out[3] = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

template <bool kWidens>
void sumSides(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& minus_sums,
              SideSums& plus_sums) {
    constexpr FourDoubles kFirst = {0, 0, 1, 1}, kSecond = {0, 1, 0, 1};
    const bool by_column = reach.by_column;
    const double at_main = by_column ? at.x : at.y, at_other = by_column ? at.y : at.x;
    const double n_main = by_column ? at.normal_x : at.normal_y;
    const double n_other = by_column ? at.normal_y : at.normal_x;
    const double slope = n_other / n_main;
    const auto row = static_cast<double>(depth.stride);
    const double along = by_column ? 1 : row, across = by_column ? row : 1;
    const int size = by_column ? depth.width : depth.height;
    const int first = reach.first < 0 ? 0 : reach.first, last = reach.last < size ? reach.last : size - 1;
    const double last_main = last, last_other = (by_column ? depth.height : depth.width) - 1;
    const float z = at.depth;
    const auto step = static_cast<double>(reach.jump * z);
    SideAccumulator minus(minus_sums), plus(plus_sums);
    FourDoubles i = first + kFirst;
    for (int column = first; column <= last; column += 2, i += 2) {
        const FourDoubles from_point = i - at_main, j = at_other + from_point * slope;
        const FourDoubles k = floorOf(j) + kSecond;
        const FourDoubles signed_distance = n_main * from_point + n_other * (k - at_other);
        const FourDoubles distance = magnitudeOf(signed_distance);
        const FourLongs inside = (i <= last_main) & (k >= 0) & (k <= last_other);
        const FourFloats there = pickFour(depth.data, only(inside, i * along + k * across));
        const FourDoubles there_known = asDoubles(there), behind = asDoubles(there - z);
        const FourLongs counts = inside & (there_known > 0) &
                                 (there_known <= static_cast<double>(__FLT_MAX__)) &
                                 (distance >= reach.clear);
        FourLongs own = counts;
        if constexpr (kWidens)
            own &=
                magnitudeOf(behind) <= asDoubles((1 + asFloats(distance / reach.widening)) * reach.jump * z);
        else
            own &= magnitudeOf(behind) <= step;
        const FourDoubles weight = 1 - magnitudeOf(j - k);
        const FourDoubles w = only(own, weight), q = only(own, asDoubles(z / there) - 1);
        const FourDoubles ws = w * distance, wq = w * q;
        FourDoubles firsts[4], lasts[4];
        transpose(w, ws, wq, ws * distance, firsts);
        transpose(ws * q, wq * q, only(counts, weight), only(counts & (behind > step), weight), lasts);
        const unsigned on_plus = laneBits(signed_distance > 0);
        for (int l = 0; l < 4; ++l) {
            SideAccumulator& side = (on_plus >> l & 1) != 0 ? plus : minus;
            side.first += firsts[l];
            side.last += lasts[l];
        }
    }
    minus.storeTo(minus_sums);
    plus.storeTo(plus_sums);
}

void sides(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& minus,
           SideSums& plus) {
    (reach.widening > 0 ? sumSides<true> : sumSides<false>)(depth, at, reach, minus, plus);
}
