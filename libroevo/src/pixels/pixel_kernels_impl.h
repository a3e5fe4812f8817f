// Included by one file per instruction set, inside an anonymous namespace. No standard containers or Eigen
// here: an inline function compiled with AVX2 must never be picked by the linker for the baseline.

constexpr int kLanes = 8;
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t IntLanes __attribute__((vector_size(4 * kLanes)));
typedef std::int16_t ShortLanes __attribute__((vector_size(2 * kLanes)));

template <class Vector, class Scalar>
inline Vector load(const Scalar* p) {
    Vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
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

/// Of one pixel; `l` and `r` are the columns to the left and right.
inline void sobel(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int l,
                  int x, int r, std::int16_t& gx, std::int16_t& gy) {
    gx = static_cast<std::int16_t>((above[r] - above[l]) + 2 * (here[r] - here[l]) + (below[r] - below[l]));
    gy = static_cast<std::int16_t>((below[l] - above[l]) + 2 * (below[x] - above[x]) + (below[r] - above[r]));
}

void gradient(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int width,
              std::int16_t* __restrict gx, std::int16_t* __restrict gy, float* __restrict magnitude) {
    const int last = width - 1;
    sobel(above, here, below, 0, 0, last > 0 ? 1 : 0, gx[0], gy[0]);
    for (int x = 1; x < last; ++x) sobel(above, here, below, x - 1, x, x + 1, gx[x], gy[x]);
    if (last > 0) sobel(above, here, below, last - 1, last, last, gx[last], gy[last]);
    for (int x = 0; x < width; ++x) {
        const auto dx = static_cast<float>(gx[x]), dy = static_cast<float>(gy[x]);
        magnitude[x] = __builtin_sqrtf(dx * dx + dy * dy);
    }
}

/// The magnitudes one step before and after a pixel along its gradient are interpolated between the two
/// neighbours that the gradient line passes; multiplied out, so that nothing is divided. ">=" on one side
/// only, so that a ridge two pixels wide keeps exactly one of them.
std::uint64_t ridges(const float* magnitude, std::ptrdiff_t stride, const std::int16_t* gx,
                     const std::int16_t* gy, int count, float low) {
    std::uint64_t found = 0;
    for (int i = 0; i < count; i += kLanes) {
        const float* m = magnitude + i;
        const Lanes here = load<Lanes>(m);
        const IntLanes enough = here >= low;
        if (bitsOf(enough) == 0) continue;
        const IntLanes x = __builtin_convertvector(load<ShortLanes>(gx + i), IntLanes);
        const IntLanes y = __builtin_convertvector(load<ShortLanes>(gy + i), IntLanes);
        const IntLanes right = x >= 0, down = y >= 0;
        const IntLanes ax = right ? x : -x, ay = down ? y : -y, by_column = ax >= ay;
        const Lanes large = __builtin_convertvector(by_column ? ax : ay, Lanes);
        const Lanes small = __builtin_convertvector(by_column ? ay : ax, Lanes);
        const Lanes n = load<Lanes>(m - stride), s = load<Lanes>(m + stride), w = load<Lanes>(m - 1),
                    e = load<Lanes>(m + 1);
        const Lanes nw = load<Lanes>(m - stride - 1), ne = load<Lanes>(m - stride + 1),
                    sw = load<Lanes>(m + stride - 1), se = load<Lanes>(m + stride + 1);
        const Lanes side_after = by_column ? (right ? e : w) : (down ? s : n);
        const Lanes side_before = by_column ? (right ? w : e) : (down ? n : s);
        const Lanes diagonal_after = right ? (down ? se : ne) : (down ? sw : nw);
        const Lanes diagonal_before = right ? (down ? nw : sw) : (down ? ne : se);
        const Lanes after = (large - small) * side_after + small * diagonal_after;
        const Lanes before = (large - small) * side_before + small * diagonal_before;
        const Lanes centre = large * here;
        found |= bitsOf(enough & (centre > before) & (centre >= after)) << i;
    }
    return count < kMostRidges ? found & ((std::uint64_t{1} << count) - 1) : found;
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

/// The lowest bytes of the first `count` lanes, which are 0 to 255.
inline void storeBytes(IntLanes values, int count, std::uint8_t* out) {
#ifdef __AVX2__
    const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128((__m256i)values),
                                           _mm256_extracti128_si256((__m256i)values, 1));
    const std::uint64_t bytes = static_cast<std::uint64_t>(_mm_cvtsi128_si64(_mm_packus_epi16(words, words)));
#else
    std::uint64_t bytes = 0;
    for (int l = 0; l < kLanes; ++l) bytes |= static_cast<std::uint64_t>(values[l]) << (8 * l);
#endif
    if (count >= kLanes)
        __builtin_memcpy(out, &bytes, sizeof bytes);
    else
        __builtin_memcpy(out, &bytes, static_cast<std::size_t>(count));
}

void remap(const std::uint8_t* image, std::ptrdiff_t stride, const Remap& from, int count,
           std::uint8_t* out) {
    constexpr int kOne = 1 << kFractionBits;
    // Two bytes early, so that the word around the last pixel ends with it
    const std::uint8_t* lower_image = image + stride - 2;
    for (int i = 0; i < count; i += kLanes) {
        const auto offset = load<IntLanes>(from.offset + i);
        const IntLanes fraction = __builtin_convertvector(load<ShortLanes>(from.fraction + i), IntLanes);
        const IntLanes right = fraction & 255, down = fraction >> 8;
        const IntLanes upper = gather(image, offset), lower = gather(lower_image, offset);
        const IntLanes i00 = upper & 255, i01 = (upper >> 8) & 255;
        const IntLanes i10 = (lower >> 16) & 255, i11 = (lower >> 24) & 255;
        const IntLanes top = kOne * i00 + right * (i01 - i00), bottom = kOne * i10 + right * (i11 - i10);
        const IntLanes value = kOne * top + down * (bottom - top);
        storeBytes((value + kOne * kOne / 2) >> (2 * kFractionBits), count - i, out + i);
    }
}
