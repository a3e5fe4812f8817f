#include "texture_tools.h"

namespace roevo::simulator {
namespace {

/// Colour from a small palette of poster inks.
Colour ink(uint64_t hash) {
    static const Colour kInks[] = {{0.85f, 0.22f, 0.16f}, {0.95f, 0.70f, 0.20f}, {0.12f, 0.35f, 0.60f},
                                   {0.10f, 0.50f, 0.42f}, {0.93f, 0.88f, 0.78f}, {0.15f, 0.15f, 0.20f},
                                   {0.55f, 0.25f, 0.45f}, {0.35f, 0.60f, 0.80f}, {0.80f, 0.45f, 0.25f},
                                   {0.40f, 0.55f, 0.25f}};
    return kInks[hash % 10];
}

/// Lines of lettering: bars of random length within rows of the given height, between `left` and `right`.
float lettering(float x, float y, float row_height, float left, float right, float w, uint32_t seed) {
    const float row = std::floor(y / row_height);
    const float cell = 0.55f * row_height;
    const float letter = std::floor(x / cell);
    const float pick = uniform(seed, static_cast<uint32_t>(static_cast<int>(row) + 100),
                               static_cast<uint32_t>(static_cast<int>(letter) + 100));
    const float end =
        right - (right - left) * 0.5f * uniform(seed + 1, static_cast<uint32_t>(static_cast<int>(row) + 100));
    if (x < left || x > end || pick < 0.15f) return 0;
    const float fx = (x / cell - letter - 0.5f) * cell, fy = (y / row_height - row - 0.5f) * row_height;
    return boxCoverage(fx, fy, cell * (0.22f + 0.2f * pick), row_height * (0.18f + 0.12f * pick), w);
}

Colour abstractPainting(const Material& m, float x, float y, float half_x, float half_y, float w) {
    Colour sum = mixColours(ink(hashOf(m.seed, 1)), Colour(0.9f, 0.87f, 0.8f), 0.6f);
    for (uint32_t i = 0; i < 12; ++i) {
        const float cx = (2 * uniform(m.seed, i, 2) - 1) * half_x,
                    cy = (2 * uniform(m.seed, i, 3) - 1) * half_y;
        const float size = (0.12f + 0.25f * uniform(m.seed, i, 4)) * half_x;
        const float angle = 3.14159f * uniform(m.seed, i, 5), c = std::cos(angle), s = std::sin(angle);
        const float dx = (x - cx) * c + (y - cy) * s, dy = (y - cy) * c - (x - cx) * s;
        float share = 0;
        if (i % 3 == 0) share = discCoverage(dx, dy, size, w);
        if (i % 3 == 1) share = boxCoverage(dx, dy, size, 0.5f * size, w);
        if (i % 3 == 2) share = coverage(0.12f * size - std::abs(std::sqrt(dx * dx + dy * dy) - size), w);
        sum = mixColours(sum, ink(hashOf(m.seed, i, 6)), share);
    }
    return sum;
}

Colour landscapePainting(const Material& m, float x, float y, float half_x, float half_y, float w) {
    const float height = y / half_y;
    Colour sum = mixColours(m.b, m.a, std::clamp(0.5f + 0.5f * height, 0.f, 1.f));
    sum = mixColours(sum, Colour(0.98f, 0.9f, 0.7f),
                     discCoverage(x - 0.35f * half_x, y - 0.5f * half_y, 0.16f * half_x, w));
    for (uint32_t ridge = 0; ridge < 4; ++ridge) {
        const auto level = static_cast<float>(ridge);
        const float crest =
            (0.25f - 0.3f * level +
             0.9f * fractalNoise(x / (0.5f * half_x) + 9 * level, 0.5f, 4, w / half_x, m.seed + ridge)) *
            half_y;
        const Colour rock = mixColours(m.b, m.c, 0.25f + 0.25f * level) *
                            (1 + 0.5f * fractalNoise(x / (0.12f * half_x), y / (0.12f * half_x), 3,
                                                     w / (0.12f * half_x), m.seed + 9));
        sum = mixColours(sum, rock, coverage(crest - y, w));
    }
    return sum;
}

Colour gridPainting(const Material& m, float x, float y, float half_x, float half_y, float w) {
    // Recursive splitting of the picture into coloured fields, with black bars between.
    float x0 = -half_x, x1 = half_x, y0 = -half_y, y1 = half_y, bar = 0;
    uint64_t id = hashOf(m.seed, 77);
    for (int depth = 0; depth < 4; ++depth) {
        const float share = 0.28f + 0.44f * static_cast<float>(uniformOf(id));
        const bool upright = (x1 - x0) > (y1 - y0);
        const float cut = upright ? x0 + share * (x1 - x0) : y0 + share * (y1 - y0);
        const float d = (upright ? x : y) - cut;
        bar = std::max(bar, coverage(0.022f * half_x - std::abs(d), w));
        id = hashOf(id, d < 0 ? 1 : 2);
        (upright ? (d < 0 ? x1 : x0) : (d < 0 ? y1 : y0)) = cut;
    }
    static const Colour kFields[] = {{0.93f, 0.91f, 0.86f}, {0.85f, 0.15f, 0.12f}, {0.93f, 0.91f, 0.86f},
                                     {0.10f, 0.22f, 0.58f}, {0.95f, 0.80f, 0.15f}, {0.88f, 0.87f, 0.84f}};
    return mixColours(kFields[id % 6], Colour(0.06f, 0.06f, 0.07f), bar);
}

Colour printedPoster(const Material& m, float x, float y, float half_x, float half_y, float w) {
    Colour sum = m.a;
    const float disc_y = y - 0.25f * half_y;
    sum = mixColours(sum, m.b, discCoverage(x, disc_y, 0.62f * half_x, w));
    sum = mixColours(sum, m.c, discCoverage(x + 0.15f * half_x, disc_y - 0.1f * half_x, 0.36f * half_x, w));
    sum = mixColours(sum, m.a * 0.8f,
                     pulses(x + y, 0.16f * half_x, 0.05f * half_x, w) *
                         discCoverage(x - 0.2f * half_x, disc_y + 0.2f * half_x, 0.25f * half_x, w));
    if (y < -0.35f * half_y && y > -0.6f * half_y)
        sum = mixColours(sum, m.b * 0.6f,
                         lettering(x, y, 0.125f * half_y, -0.75f * half_x, 0.95f * half_x, w, m.seed));
    if (y < -0.66f * half_y && y > -0.9f * half_y)
        sum = mixColours(sum, m.b * 0.6f,
                         lettering(x, y, 0.05f * half_y, -0.75f * half_x, 0.75f * half_x, w, m.seed + 5));
    return sum;
}

}  // namespace

Colour posterColour(const Material& m, const SurfacePoint& p) {
    const float margin = 0.06f * std::min(p.half_u, p.half_v);
    const float half_x = p.half_u - margin, half_y = p.half_v - margin;
    Colour picture = m.a;
    switch (m.seed % 4) {
        case 0:
            picture = abstractPainting(m, p.u, p.v, half_x, half_y, p.footprint);
            break;
        case 1:
            picture = landscapePainting(m, p.u, p.v, half_x, half_y, p.footprint);
            break;
        case 2:
            picture = gridPainting(m, p.u, p.v, half_x, half_y, p.footprint);
            break;
        default:
            picture = printedPoster(m, p.u, p.v, half_x, half_y, p.footprint);
            break;
    }
    return mixColours(Colour(0.92f, 0.91f, 0.88f), picture,
                      boxCoverage(p.u, p.v, half_x, half_y, p.footprint));
}

Colour bookColour(const Material& m, const SurfacePoint& p) {
    const float w = p.footprint, height = p.v / p.half_v;
    const float wv = w / p.half_v;
    Colour sum = m.a * (1 + 0.15f * fractalNoise(p.u / 0.01f, p.v / 0.03f, 2, w / 0.01f, m.seed));
    const float style = uniform(m.seed, 1);
    const float band = 0.55f + 0.3f * uniform(m.seed, 2);
    if (style < 0.6f) {
        sum = mixColours(sum, m.b, coverage(0.04f - std::abs(std::abs(height) - band), wv));
        sum = mixColours(sum, m.b, coverage(0.015f - std::abs(std::abs(height) - band + 0.1f), wv));
    }
    const float middle = 0.3f * (uniform(m.seed, 3) - 0.5f);
    if (style > 0.35f) {  // a label across the spine
        const float label = coverage(0.17f - std::abs(height - middle), wv);
        sum = mixColours(sum, m.c, label);
    }
    const float tall = std::min(0.6f * p.half_u, 0.012f);  // the title, written along the spine
    const float title =
        boxCoverage(p.u, p.v, tall, 0.42f * p.half_v, w) * pulses(p.v, 1.2f * tall, 0.75f * tall, w);
    return mixColours(sum, style > 0.35f ? m.a * 0.5f : m.c, 0.8f * title);
}

Colour windowViewColour(const Material& m, const SurfacePoint& p) {
    const float w = p.footprint, y = p.v / p.half_v;
    Colour sum = mixColours(m.b, m.a, std::clamp(0.5f + 0.6f * y, 0.f, 1.f));
    const float cloud = fractalNoise(p.u / 0.5f, p.v / 0.22f, 4, w / 0.22f, m.seed);
    sum = mixColours(sum, Colour(1, 1, 1), std::clamp(2.2f * cloud, 0.f, 0.9f));
    const float hill = (-0.15f + 0.5f * fractalNoise(p.u / 0.4f, 3.f, 4, w / 0.4f, m.seed + 5)) * p.half_v;
    sum = mixColours(sum, Colour(0.55f, 0.65f, 0.6f), coverage(hill - p.v, w));
    for (uint32_t i = 0; i < 6; ++i) {  // houses
        const float x = (-0.95f + 0.37f * static_cast<float>(i)) * p.half_u;
        const float half = (0.13f + 0.06f * uniform(m.seed, i, 1)) * p.half_u;
        const float top = (-0.35f + 0.5f * uniform(m.seed, i, 2)) * p.half_v;
        const float wall = coverage(half - std::abs(p.u - x), w) * coverage(top - p.v, w);
        const float panes = pulses(p.u - x, 0.08f, 0.04f, w) * pulses(p.v - top, 0.1f, 0.055f, w);
        const Colour front = mixColours(ink(hashOf(m.seed, i, 3)), Colour(0.8f, 0.76f, 0.7f), 0.55f);
        sum = mixColours(sum, mixColours(front, Colour(0.25f, 0.28f, 0.34f), panes), wall);
    }
    const float bush = (-0.78f + 0.35f * fractalNoise(p.u / 0.13f, 8.f, 4, w / 0.13f, m.seed + 8)) * p.half_v;
    const Colour leaves = Colour(0.25f, 0.42f, 0.18f) *
                          (1 + 0.9f * fractalNoise(p.u / 0.05f, p.v / 0.05f, 3, w / 0.05f, m.seed + 9));
    return mixColours(sum, leaves, coverage(bush - p.v, w));
}

Colour clockColour(const Material& m, const SurfacePoint& p) {
    const float w = p.footprint, r = std::sqrt(p.u * p.u + p.v * p.v) / p.half_u, wr = w / p.half_u;
    const float angle = std::atan2(p.u, p.v) / 6.2831853f;
    Colour sum = mixColours(m.b, m.a, coverage(0.9f - r, wr));
    const float hour = (fractionOf(angle * 12 + 0.5f) - 0.5f) / 12 * 6.2831853f * r;
    sum = mixColours(sum, m.b,
                     coverage(0.025f - std::abs(hour), wr) * coverage(0.08f - std::abs(r - 0.75f), wr));
    const auto hand = [&](float turn, float length, float half_width) {
        const float c = std::cos(6.2831853f * turn), s = std::sin(6.2831853f * turn);
        const float along = (p.v * c + p.u * s) / p.half_u, across = (p.u * c - p.v * s) / p.half_u;
        return coverage(half_width - std::abs(across), wr) *
               coverage(0.5f * length - std::abs(along - 0.4f * length), wr);
    };
    sum = mixColours(sum, m.b, hand(0.845f, 0.55f, 0.035f));
    return mixColours(sum, m.c, hand(0.14f, 0.75f, 0.022f));
}

}  // namespace roevo::simulator
