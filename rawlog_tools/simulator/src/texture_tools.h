#pragma once
/// Building blocks of procedural textures, each filtered over the sample's footprint.

#include <algorithm>
#include <cmath>

#include "random.h"
#include "texture.h"

namespace roevo::simulator {

inline float fractionOf(float x) {
    return x - std::floor(x);
}

inline Colour mixColours(const Colour& a, const Colour& b, float share) {
    return a + (b - a) * share;
}

/// Share of the footprint `w` inside a border at signed distance `d` (positive inside).
inline float coverage(float d, float w) {
    return std::clamp(d / w + 0.5f, 0.f, 1.f);
}

inline float discCoverage(float x, float y, float radius, float w) {
    return coverage(radius - std::sqrt(x * x + y * y), w);
}

inline float boxCoverage(float x, float y, float half_x, float half_y, float w) {
    return coverage(half_x - std::abs(x), w) * coverage(half_y - std::abs(y), w);
}

/// Pulse train of the given period whose first `width` is 1, averaged over the footprint exactly.
inline float pulses(float x, float period, float width, float w) {
    const auto integral = [=](float at) {
        const float cell = std::floor(at / period);
        return cell * width + std::min(at - cell * period, width);
    };
    const float span = std::max(w, 1e-5f);
    return (integral(x + 0.5f * span) - integral(x - 0.5f * span)) / span;
}

/// Smooth lattice noise in 0..1 with features of size 1.
inline float latticeNoise(float x, float y, uint32_t seed) {
    const float fx = std::floor(x), fy = std::floor(y);
    const auto ix = static_cast<int32_t>(fx), iy = static_cast<int32_t>(fy);
    const float ax = x - fx, ay = y - fy;
    const auto corner = [seed](int32_t cx, int32_t cy) {
        uint32_t h = static_cast<uint32_t>(cx) * 0x85ebca6bU ^
                     (static_cast<uint32_t>(cy) * 0xc2b2ae35U + seed * 0x9e3779b9U);
        h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
        h = (h ^ (h >> 12)) * 0x297a2d39U;
        return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1.0p-24f;
    };
    const float sx = ax * ax * (3 - 2 * ax), sy = ay * ay * (3 - 2 * ay);
    const float low = corner(ix, iy) * (1 - sx) + corner(ix + 1, iy) * sx;
    const float high = corner(ix, iy + 1) * (1 - sx) + corner(ix + 1, iy + 1) * sx;
    return low * (1 - sy) + high * sy;
}

/// Octaves of lattice noise around 0, about -0.5..0.5. An octave finer than the footprint `w` is faded out.
inline float fractalNoise(float x, float y, int octaves, float w, uint32_t seed) {
    float sum = 0, gain = 0.6f;
    for (int i = 0; i < octaves; ++i) {
        const float fade = std::clamp(2.f - 2.5f * w, 0.f, 1.f);
        if (fade <= 0) break;
        sum += gain * fade * (latticeNoise(x, y, seed + static_cast<uint32_t>(i)) - 0.5f);
        x *= 2.03f, y *= 2.03f, w *= 2.03f, gain *= 0.55f;
    }
    return sum;
}

/// Textures of pictures: paintings, books, clock, what is seen through the window (texture_pictures.cpp).
Colour posterColour(const Material& material, const SurfacePoint& point);
Colour bookColour(const Material& material, const SurfacePoint& point);
Colour windowViewColour(const Material& material, const SurfacePoint& point);
Colour clockColour(const Material& material, const SurfacePoint& point);

}  // namespace roevo::simulator
