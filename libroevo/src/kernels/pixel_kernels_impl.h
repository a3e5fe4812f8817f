// Included by one file per instruction set, inside an anonymous namespace; what lanes_impl.h says of itself
// holds here.

typedef std::int16_t ShortLanes __attribute__((vector_size(2 * kLanes)));
typedef std::int16_t WideShorts __attribute__((vector_size(4 * kLanes)));  ///< twice as many
typedef std::uint8_t WideBytes __attribute__((vector_size(2 * kLanes)));

/// Of one pixel; `l` and `r` are the columns to the left and right.
inline void sobelAndNorm(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                         int l, int x, int r, std::int16_t* gx, std::int16_t* gy, float* magnitude) {
    const int dx = (above[r] - above[l]) + 2 * (here[r] - here[l]) + (below[r] - below[l]);
    const int dy = (below[l] - above[l]) + 2 * (below[x] - above[x]) + (below[r] - above[r]);
    gx[x] = static_cast<std::int16_t>(dx);
    gy[x] = static_cast<std::int16_t>(dy);
    magnitude[x] = __builtin_sqrtf(static_cast<float>(dx * dx + dy * dy));  // the sum is exact
}

inline WideShorts widen(const std::uint8_t* p) {
#ifdef __AVX2__
    return (WideShorts)_mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
#else
    return __builtin_convertvector(load<WideBytes>(p), WideShorts);
#endif
}

/// Euclidean norms; squares and sums are exact.
inline void storeNorms(WideShorts gx, WideShorts gy, float* magnitude) {
#ifdef __AVX2__
    const __m256i even = _mm256_unpacklo_epi16((__m256i)gx, (__m256i)gy),
                  odd = _mm256_unpackhi_epi16((__m256i)gx, (__m256i)gy);
    const __m256i low = _mm256_madd_epi16(even, even), high = _mm256_madd_epi16(odd, odd);
    const __m256i first = _mm256_permute2x128_si256(low, high, 0x20),
                  second = _mm256_permute2x128_si256(low, high, 0x31);
    _mm256_storeu_ps(magnitude, _mm256_sqrt_ps(_mm256_cvtepi32_ps(first)));
    _mm256_storeu_ps(magnitude + kLanes, _mm256_sqrt_ps(_mm256_cvtepi32_ps(second)));
#else
    for (int l = 0; l < 2 * kLanes; ++l) {
        const auto dx = static_cast<float>(gx[l]), dy = static_cast<float>(gy[l]);
        magnitude[l] = __builtin_sqrtf(dx * dx + dy * dy);
    }
#endif
}

void gradient(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int width,
              std::int16_t* __restrict gx, std::int16_t* __restrict gy, float* __restrict magnitude) {
    constexpr int kBlock = 2 * kLanes;
    const int last = width - 1;
    sobelAndNorm(above, here, below, 0, 0, last > 0 ? 1 : 0, gx, gy, magnitude);
    if (last > 0) sobelAndNorm(above, here, below, last - 1, last, last, gx, gy, magnitude);
    if (last - 1 < kBlock) {
        for (int x = 1; x < last; ++x) sobelAndNorm(above, here, below, x - 1, x, x + 1, gx, gy, magnitude);
        return;
    }
    for (int first = 1; first < last; first += kBlock) {
        const int x = first < last - kBlock ? first : last - kBlock;  // the last ones may be done twice
        const WideShorts nw = widen(above + x - 1), n = widen(above + x), ne = widen(above + x + 1);
        const WideShorts w = widen(here + x - 1), e = widen(here + x + 1);
        const WideShorts sw = widen(below + x - 1), s = widen(below + x), se = widen(below + x + 1);
        const WideShorts dx = (ne - nw) + 2 * (e - w) + (se - sw), dy = (sw - nw) + 2 * (s - n) + (se - ne);
        store(gx + x, dx);
        store(gy + x, dy);
        storeNorms(dx, dy, magnitude + x);
    }
}

/// The magnitudes one step before and after a pixel along its gradient are interpolated between the two
/// neighbours that the gradient line passes; multiplied out, so that nothing is divided. ">=" on one side
/// only, so that a ridge two pixels wide keeps exactly one of them.
Ridges ridges(const float* magnitude, std::ptrdiff_t stride, const std::int16_t* gx, const std::int16_t* gy,
              int count, float low, float high) {
    Ridges found{0, 0};
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
        const IntLanes ridge = enough & (centre > before) & (centre >= after);
        found.all |= bitsOf(ridge) << i;
        found.strong |= bitsOf(ridge & (here >= high)) << i;
    }
    const std::uint64_t inside = count < kMostRidges ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
    return {found.all & inside, found.strong & inside};
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

/// Of eight pixels, the four neighbours of each: the upper two in the lower bytes. They end before `end`.
inline IntLanes neighbours(const std::uint8_t* image, std::ptrdiff_t stride, IntLanes offset,
                           const std::uint8_t* end) {
#ifdef __AVX2__
    // Mostly all eight come from the same two rows, near each other: shuffled bytes cost less than gathered
    // ones
    constexpr int kTogether = 16;
    const std::uint8_t* first = image + offset[0];
    const IntLanes further = offset - offset[0];
    const bool together = !any((further < 0) | (further > kTogether - 2));
    if (together && end - first >= stride + kTogether) {
        const auto sixteen = [](const std::uint8_t* p) {
            return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
        };
        const auto nothing = static_cast<std::int32_t>(0x80808080U);
        const IntLanes pairs = (further | further << 8) + 0x0100;
        const __m256i upper = (__m256i)(pairs | (nothing & ~0xFFFF)),
                      lower = (__m256i)(pairs << 16 | (nothing & 0xFFFF));
        return (IntLanes)_mm256_or_si256(_mm256_shuffle_epi8(sixteen(first), upper),
                                         _mm256_shuffle_epi8(sixteen(first + stride), lower));
    }
    // Two bytes early, so that the word around the last pixel ends with it
    return (IntLanes)_mm256_blend_epi16((__m256i)gather(image, offset),
                                        (__m256i)gather(image + stride - 2, offset), 0xAA);
#else
    static_cast<void>(end);
    return (gather(image, offset) & 0xFFFF) | (gather(image + stride - 2, offset) & ~0xFFFF);
#endif
}

/// Of eight pixels, these neighbours blended, in 1/1024 of a grey level.
inline IntLanes blend(IntLanes four, ShortLanes fractions) {
#ifdef __AVX2__
    // [32 - f, f] of both directions, as weights of neighbouring bytes and of neighbouring words
    const __m256i fraction = _mm256_cvtepi16_epi32((__m128i)fractions);
    const __m256i right =
        _mm256_shuffle_epi8(fraction, _mm256_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12, 0,
                                                       0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12));
    const __m256i down = _mm256_shuffle_epi8(
        fraction, _mm256_setr_epi8(1, -1, 1, -1, 5, -1, 5, -1, 9, -1, 9, -1, 13, -1, 13, -1, 1, -1, 1, -1, 5,
                                   -1, 5, -1, 9, -1, 9, -1, 13, -1, 13, -1));
    const __m256i by_bytes = _mm256_add_epi8(_mm256_sign_epi8(right, _mm256_set1_epi16(0x01FF)),
                                             _mm256_set1_epi16(1 << kFractionBits));
    const __m256i by_words = _mm256_add_epi16(_mm256_sign_epi16(down, _mm256_set1_epi32(0x0001FFFF)),
                                              _mm256_set1_epi32(1 << kFractionBits));
    return (IntLanes)_mm256_madd_epi16(_mm256_maddubs_epi16((__m256i)four, by_bytes), by_words);
#else
    constexpr int kOne = 1 << kFractionBits;
    const IntLanes fraction = __builtin_convertvector(fractions, IntLanes);
    const IntLanes right = fraction & 255, down = fraction >> 8;
    const IntLanes i00 = four & 255, i01 = (four >> 8) & 255;
    const IntLanes i10 = (four >> 16) & 255, i11 = (four >> 24) & 255;
    const IntLanes top = kOne * i00 + right * (i01 - i00), bottom = kOne * i10 + right * (i11 - i10);
    return kOne * top + down * (bottom - top);
#endif
}

void remap(const std::uint8_t* image, const std::uint8_t* end, std::ptrdiff_t stride, const Remap& from,
           int count, std::uint8_t* out) {
    for (int i = 0; i < count; i += kLanes) {
        const auto offset = load<IntLanes>(from.offset + i);
        const IntLanes value =
            blend(neighbours(image, stride, offset, end), load<ShortLanes>(from.fraction + i));
        storeBytes((value + (1 << (2 * kFractionBits - 1))) >> (2 * kFractionBits), count - i, out + i);
    }
}

void halve(const std::uint8_t* upper, const std::uint8_t* lower, int count, std::uint8_t* out) {
    for (int i = 0; i < count; ++i)
        out[i] = static_cast<std::uint8_t>(
            (upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1] + 2) >> 2);
}
