#include "texture.h"

#include "texture_tools.h"

namespace roevo::simulator {
namespace {

Colour plasterColour(const Material& m, const SurfacePoint& p) {
    const float s = m.scale;
    const float stains =
        fractalNoise(p.u / (0.9f * s), p.v / (0.9f * s), 2, p.footprint / (0.9f * s), m.seed);
    const float grain =
        fractalNoise(p.u / (0.03f * s), p.v / (0.03f * s), 2, p.footprint / (0.03f * s), m.seed + 7);
    return m.a * (1 + 0.05f * stains + 0.05f * grain);
}

float woodGrain(float along, float across, float w, uint32_t seed) {
    const float warp = 0.25f * fractalNoise(along / 0.5f, across / 0.08f, 1, w / 0.08f, seed);
    const float rings = fractalNoise(along / 0.35f, across / 0.012f + 3 * warp, 3, w / 0.012f, seed + 3);
    return 0.7f * rings + warp;
}

Colour woodColour(const Material& m, const SurfacePoint& p) {
    const bool lying = p.half_u >= p.half_v;  // grain runs along the longer side
    const float grain = woodGrain((lying ? p.u : p.v) / m.scale, (lying ? p.v : p.u) / m.scale,
                                  p.footprint / m.scale, m.seed);
    return mixColours(m.a, m.b, std::clamp(0.3f + 0.9f * grain, 0.f, 1.f));
}

Colour planksColour(const Material& m, const SurfacePoint& p) {
    const float width = 0.13f * m.scale, length = 1.15f * m.scale;
    const float row = std::floor(p.v / width);
    const float shift = length * uniform(m.seed, static_cast<uint32_t>(static_cast<int>(row) + 1000));
    const float u = p.u + shift, plank = std::floor(u / length);
    const uint64_t id = hashOf(m.seed, static_cast<uint32_t>(static_cast<int>(row) + 1000),
                               static_cast<uint32_t>(static_cast<int>(plank) + 1000));
    const float tone = static_cast<float>(uniformOf(id));
    const float grain = woodGrain(p.u, p.v + 3 * tone, p.footprint, static_cast<uint32_t>(id));
    const float gap = 0.003f;
    const float gaps = std::max(pulses(p.v + 0.5f * gap, width, gap, p.footprint),
                                pulses(u + 0.5f * gap, length, gap, p.footprint));
    const Colour wood = mixColours(m.a, m.b, std::clamp(0.15f + 0.6f * tone + 0.6f * grain, 0.f, 1.f));
    return wood * (1 - 0.7f * gaps);
}

Colour fabricColour(const Material& m, const SurfacePoint& p) {
    const float thread = 0.006f * m.scale;
    const float weave =
        pulses(p.u, thread, 0.5f * thread, p.footprint) + pulses(p.v, thread, 0.5f * thread, p.footprint) - 1;
    const float blotches = fractalNoise(p.u / 0.12f, p.v / 0.12f, 4, p.footprint / 0.12f, m.seed);
    return mixColours(m.a, m.b, std::clamp(0.4f + 0.7f * blotches + 0.3f * weave, 0.f, 1.f));
}

Colour stripesColour(const Material& m, const SurfacePoint& p) {
    const float period = m.scale;
    const float broad = pulses(p.u, period, 0.5f * period, p.footprint);
    const float fine = pulses(p.u - 0.2f * period, 0.5f * period, 0.06f * period, p.footprint);
    const float grain = fractalNoise(p.u / 0.02f, p.v / 0.06f, 2, p.footprint / 0.02f, m.seed);
    return mixColours(mixColours(m.a, m.b, broad), m.c, fine) * (1 + 0.06f * grain);
}

Colour tilesColour(const Material& m, const SurfacePoint& p) {
    const float size = m.scale, joint = 0.02f * size;
    const float joints =
        std::max(pulses(p.u, size, joint, p.footprint), pulses(p.v, size, joint, p.footprint));
    const uint64_t id = hashOf(m.seed, static_cast<uint32_t>(static_cast<int>(std::floor(p.u / size)) + 5000),
                               static_cast<uint32_t>(static_cast<int>(std::floor(p.v / size)) + 5000));
    const float tone = static_cast<float>(uniformOf(id));
    const float grain = fractalNoise(p.u / 0.05f, p.v / 0.05f, 3, p.footprint / 0.05f, m.seed);
    return mixColours(m.a * (0.97f + 0.06f * tone + 0.06f * grain), m.b, joints);
}

Colour carpetColour(const Material& m, const SurfacePoint& p) {
    const float w = p.footprint;
    const float from_rim = std::min(p.half_u - std::abs(p.u), p.half_v - std::abs(p.v));
    // Field of lozenges with a dot in each.
    const float step = 0.34f;
    const float a = fractionOf((p.u + p.v) / step) - 0.5f, b = fractionOf((p.u - p.v) / step) - 0.5f;
    const float lozenge = boxCoverage(a, b, 0.43f, 0.43f, 2 * w / step);
    const float inner = boxCoverage(a, b, 0.27f, 0.27f, 2 * w / step),
                dot = discCoverage(a, b, 0.13f, 2 * w / step);
    Colour field = mixColours(m.c, m.a, lozenge);
    field = mixColours(field, m.b, inner);
    field = mixColours(field, m.c, dot);
    // Medallion.
    const float radius = std::sqrt(p.u * p.u + 1.6f * p.v * p.v), angle = std::atan2(1.26f * p.v, p.u);
    const float petal = 0.42f + 0.06f * std::cos(12 * angle);
    field = mixColours(field, m.c, coverage(petal - radius, w));
    field = mixColours(field, m.b, coverage(petal - 0.05f - radius, w));
    field = mixColours(field, m.a, coverage(0.26f + 0.04f * std::cos(8 * angle) - radius, w));
    field = mixColours(field, m.c, coverage(0.09f - radius, w));
    // Border: bands and a row of triangles along it.
    const bool on_long_side = p.half_v - std::abs(p.v) < p.half_u - std::abs(p.u);
    const float along = on_long_side ? p.u : p.v;
    const float saw = std::abs(fractionOf(along / 0.11f) - 0.5f) * 0.22f;
    Colour border =
        mixColours(m.b, m.c, coverage(saw - (from_rim - 0.09f), w) * coverage(from_rim - 0.09f, w));
    border = mixColours(m.a, border, coverage(from_rim - 0.05f, w));
    border = mixColours(border, m.c, coverage(0.012f - std::abs(from_rim - 0.05f), w));
    Colour all = mixColours(border, field, coverage(from_rim - 0.24f, w));
    all = mixColours(all, m.c, coverage(0.012f - std::abs(from_rim - 0.24f), w));
    const float pile = fractalNoise(p.u / 0.02f, p.v / 0.02f, 2, w / 0.02f, m.seed);
    return all * (1 + 0.25f * pile);
}

Colour foliageColour(const Material& m, const SurfacePoint& p) {
    const float blotch = fractalNoise(p.u / 0.05f, p.v / 0.09f, 3, p.footprint / 0.05f, m.seed);
    const float vein = coverage(0.012f - std::abs(p.u), p.footprint);
    return mixColours(mixColours(m.a, m.b, std::clamp(0.5f + 1.3f * blotch, 0.f, 1.f)), m.c, 0.6f * vein);
}

/// A panelled door leaf: two sunk panels with bevels drawn as light and dark lines.
Colour doorColour(const Material& m, const SurfacePoint& p) {
    const float w = p.footprint;
    Colour leaf = m.a;
    for (const float side : {-1.f, 1.f}) {
        const float half_y = side > 0 ? 0.34f * p.half_v : 0.44f * p.half_v;
        const float y = p.v - (side > 0 ? 0.52f : -0.42f) * p.half_v;
        const float outer = boxCoverage(p.u, y, 0.7f * p.half_u, half_y, w);
        const float panel = boxCoverage(p.u, y, 0.7f * p.half_u - 0.018f, half_y - 0.018f, w);
        leaf = mixColours(leaf, y < -0.97f * half_y ? m.c : m.b, outer);
        leaf = mixColours(leaf, m.a * 0.96f, panel);
    }
    return leaf;
}

}  // namespace

Colour textureColour(const Material& m, const SurfacePoint& p) {
    switch (m.texture) {
        case Texture::kPlain:
            return m.a;
        case Texture::kPlaster:
            return plasterColour(m, p);
        case Texture::kPlanks:
            return planksColour(m, p);
        case Texture::kWood:
            return woodColour(m, p);
        case Texture::kFabric:
            return fabricColour(m, p);
        case Texture::kStripes:
            return stripesColour(m, p);
        case Texture::kTiles:
            return tilesColour(m, p);
        case Texture::kCarpet:
            return carpetColour(m, p);
        case Texture::kPoster:
            return posterColour(m, p);
        case Texture::kBook:
            return bookColour(m, p);
        case Texture::kWindowView:
            return windowViewColour(m, p);
        case Texture::kClock:
            return clockColour(m, p);
        case Texture::kFoliage:
            return foliageColour(m, p);
        case Texture::kDoor:
            return doorColour(m, p);
    }
    return m.a;
}

}  // namespace roevo::simulator
