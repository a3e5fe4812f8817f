// The surfaces on both sides of an edge's point; what pixel_kernels_impl.h says of itself holds here.
#include "edge_kernels_impl.h"

// Four samples: two columns (or rows) of two pixels, in the order in which they are summed
typedef double FourDoubles __attribute__((vector_size(32)));
typedef std::int64_t FourLongs __attribute__((vector_size(32)));
typedef float FourFloats __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

inline FourFloats pickFour(const float* values, FourInts index) {
#ifdef __AVX2__
    return (FourFloats)_mm_i32gather_ps(values, (__m128i)index, 4);
#else
    return FourFloats{values[index[0]], values[index[1]], values[index[2]], values[index[3]]};
#endif
}

inline unsigned bitsOf(FourLongs condition) {
#ifdef __AVX2__
    return static_cast<unsigned>(_mm256_movemask_pd((__m256d)condition));
#else
    unsigned bits = 0;
    for (int l = 0; l < 4; ++l) bits |= static_cast<unsigned>(condition[l] & 1) << l;
    return bits;
#endif
}

/// Sums in the order of SideSums.
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

void sides(const DepthView& depth, const EdgePoint& at, const SideReach& reach, SideSums& minus_sums,
           SideSums& plus_sums) {
    constexpr FourInts kFirst = {0, 0, 1, 1}, kSecond = {0, 1, 0, 1};
    const bool by_column = reach.by_column;
    const double at_main = by_column ? at.x : at.y, at_other = by_column ? at.y : at.x;
    const double n_main = by_column ? at.normal_x : at.normal_y,
                 n_other = by_column ? at.normal_y : at.normal_x;
    const double slope = n_other / n_main;
    const auto row = static_cast<std::int32_t>(depth.stride);
    const std::int32_t along = by_column ? 1 : row, across = by_column ? row : 1;
    const std::int32_t size = by_column ? depth.width : depth.height,
                       other_size = by_column ? depth.height : depth.width;
    const std::int32_t first = reach.first < 0 ? 0 : reach.first,
                       last = reach.last < size ? reach.last : size - 1;
    const float z = at.depth, step = reach.jump * z;
    SideAccumulator minus(minus_sums), plus(plus_sums);
    for (std::int32_t column = first; column <= last; column += 2) {
        const FourInts i = column + kFirst;
        const FourDoubles from_point = __builtin_convertvector(i, FourDoubles) - at_main;
        const FourDoubles j = at_other + from_point * slope;
        const FourInts towards_zero = __builtin_convertvector(j, FourInts);
        const FourLongs above = __builtin_convertvector(towards_zero, FourDoubles) > j;
        const FourInts k = towards_zero + __builtin_convertvector(above, FourInts) + kSecond;
        const FourDoubles on_other = __builtin_convertvector(k, FourDoubles);
        const FourDoubles signed_distance = n_main * from_point + n_other * (on_other - at_other);
        const FourDoubles distance = signed_distance < 0 ? -signed_distance : signed_distance;
        const FourInts inside = (i <= last) & (k >= 0) & (k < other_size);
        const FourFloats there = pickFour(depth.data, inside & (i * along + k * across));
        const FourInts known = inside & (there > 0) & (there <= __FLT_MAX__);
        const FourLongs counts = __builtin_convertvector(known, FourLongs) & (distance >= reach.clear);
        const FourFloats behind = there - z, apart = behind < 0 ? -behind : behind;
        const FourFloats widened = 1 + __builtin_convertvector(distance / reach.widening, FourFloats);
        const FourLongs own = counts & __builtin_convertvector(apart <= widened * reach.jump * z, FourLongs);
        const FourLongs beyond = counts & __builtin_convertvector(behind > step, FourLongs);
        const FourDoubles off = j - on_other, weight = 1 - (off < 0 ? -off : off);
        const FourDoubles w = (FourDoubles)((FourLongs)weight & own);
        const FourDoubles relative = __builtin_convertvector(z / there, FourDoubles) - 1;
        const FourDoubles q = (FourDoubles)((FourLongs)relative & own);
        const FourDoubles ws = w * distance, wq = w * q;
        FourDoubles firsts[4], lasts[4];
        transpose(w, ws, wq, ws * distance, firsts);
        transpose(ws * q, wq * q, (FourDoubles)((FourLongs)weight & counts),
                  (FourDoubles)((FourLongs)weight & beyond), lasts);
        const unsigned on_plus = bitsOf(signed_distance > 0);
        for (int l = 0; l < 4; ++l) {
            SideAccumulator& side = (on_plus >> l & 1) != 0 ? plus : minus;
            side.first += firsts[l];
            side.last += lasts[l];
        }
    }
    minus.storeTo(minus_sums);
    plus.storeTo(plus_sums);
}
