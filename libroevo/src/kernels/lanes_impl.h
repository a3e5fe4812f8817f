// Eight values at once. Included by what one file per instruction set includes, inside an anonymous
// namespace. No standard containers or Eigen here: an inline function compiled with AVX2 must never be picked
// by the linker for the baseline.

typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t IntLanes __attribute__((vector_size(4 * kLanes)));
constexpr IntLanes kLane = {0, 1, 2, 3, 4, 5, 6, 7};

template <class Vector = Lanes, class Scalar>
inline Vector load(const Scalar* p) {
    Vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}

template <class Vector, class Scalar>
inline void store(Scalar* p, Vector v) {
    __builtin_memcpy(p, &v, sizeof v);
}

/// A block that ends after `count` values or is whole; the first value stands in for those that are not
/// there.
template <class Vector = Lanes, class Scalar>
inline Vector loadSome(const Scalar* p, std::size_t count) {
    if (count >= kLanes) return load<Vector>(p);
    Vector v = Vector{} + *p;
    __builtin_memcpy(&v, p, count * sizeof *p);
    return v;
}

template <class Vector, class Scalar>
inline void storeSome(Scalar* p, Vector v, std::size_t count) {
    if (count >= kLanes)
        store(p, v);
    else
        __builtin_memcpy(p, &v, count * sizeof *p);
}

inline Lanes splat(float value) {
    return Lanes{} + value;
}

/// values[index], of each lane.
inline Lanes pickLanes(const float* values, IntLanes index) {
#ifdef __AVX2__
    return (Lanes)_mm256_i32gather_ps(values, (__m256i)index, 4);
#else
    Lanes out;
    for (int l = 0; l < kLanes; ++l) out[l] = values[index[l]];
    return out;
#endif
}

inline IntLanes pickLanes(const std::int32_t* values, IntLanes index) {
#ifdef __AVX2__
    return (IntLanes)_mm256_i32gather_epi32(values, (__m256i)index, 4);
#else
    IntLanes out;
    for (int l = 0; l < kLanes; ++l) out[l] = values[index[l]];
    return out;
#endif
}

/// The words of four bytes at these places.
inline IntLanes gather(const std::uint8_t* data, IntLanes index) {
#ifdef __AVX2__
    return (IntLanes)_mm256_i32gather_epi32(reinterpret_cast<const int*>(data), (__m256i)index, 1);
#else
    IntLanes words;
    for (int l = 0; l < kLanes; ++l) {
        std::int32_t word;
        __builtin_memcpy(&word, data + index[l], sizeof word);
        words[l] = word;
    }
    return words;
#endif
}

/// One bit for each lane that is true.
inline std::uint64_t bitsOf(IntLanes condition) {
#ifdef __AVX2__
    return static_cast<std::uint64_t>(_mm256_movemask_ps((__m256)condition));
#else
    std::uint64_t bits = 0;
    for (int l = 0; l < kLanes; ++l) bits |= static_cast<std::uint64_t>(condition[l] & 1) << l;
    return bits;
#endif
}

inline bool any(IntLanes condition) {
    return bitsOf(condition) != 0;
}

inline Lanes squareRoot(Lanes v) {
#ifdef __AVX2__
    return (Lanes)_mm256_sqrt_ps((__m256)v);
#else
    for (int l = 0; l < kLanes; ++l) v[l] = __builtin_sqrtf(v[l]);
    return v;
#endif
}

inline Lanes magnitudeOf(Lanes v) {
    return v < 0 ? -v : v;
}

/// Sum of the lanes in a fixed order.
inline float sumLanes(Lanes v) {
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// The sums of the lanes of eight vectors, each in that order.
inline Lanes sumsOf(const Lanes* v) {
#ifdef __AVX2__
    const auto halves = [&](int i, int j) {  // l + (l + 4): four of v[i], four of v[j]
        const __m256 a = (__m256)v[i], b = (__m256)v[j];
        return _mm256_add_ps(_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31));
    };
    const auto quarters = [](__m256 a, __m256 b) {  // two of each
        return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x44), _mm256_shuffle_ps(a, b, 0xEE));
    };
    const __m256 even = quarters(halves(0, 4), halves(1, 5)), odd = quarters(halves(2, 6), halves(3, 7));
    return (Lanes)_mm256_add_ps(_mm256_shuffle_ps(even, odd, 0x88), _mm256_shuffle_ps(even, odd, 0xDD));
#else
    Lanes sums;
    for (int l = 0; l < kLanes; ++l) sums[l] = sumLanes(v[l]);
    return sums;
#endif
}
