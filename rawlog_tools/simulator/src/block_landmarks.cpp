#include <cmath>

#include "block_pieces.h"
#include "random.h"

namespace roevo::simulator::block {
namespace {

constexpr double kEnd = 2 * kHalfWidth;  // x of the wall that a corridor ends at

int poster(SceneBuilder& b, uint32_t seed) {
    const int material =
        b.material(Texture::kPoster, {0.90f, 0.84f, 0.68f}, {0.70f, 0.22f, 0.16f}, {0.15f, 0.34f, 0.46f});
    b.scene.materials[static_cast<size_t>(material)].seed = seed;
    return material;
}

/// A picture in a frame on the wall at the corridor's end.
void hang(const Spot& spot, const Materials& m, double y, double z, double width, double height,
          int picture) {
    spot.box({kEnd - 0.02, y - 0.5 * width - 0.03, z - 0.5 * height - 0.03},
             {kEnd, y + 0.5 * width + 0.03, z + 0.5 * height + 0.03}, m.dark);
    spot.sheet({kEnd - 0.022, y, z}, width, height, -V::UnitX(), picture);
}

void addPlant(SceneBuilder& b, const Spot& spot, const V& foot) {
    const int pot = b.material(Texture::kStripes, {0.86f, 0.84f, 0.80f}, {0.55f, 0.30f, 0.20f},
                               {0.35f, 0.40f, 0.45f}, 0.16f);
    const int leaf =
        b.material(Texture::kFoliage, {0.10f, 0.30f, 0.12f}, {0.25f, 0.48f, 0.18f}, {0.50f, 0.66f, 0.34f});
    spot.cylinder(foot, 0.16, 0.36, pot, 1.25);
    for (uint32_t i = 0; i < 9; ++i) {
        const double angle = 2.4 * i, lean = 0.08 + 0.12 * uniform(11, i, 1),
                     height = 0.75 + 0.7 * uniform(11, i, 2);
        const V tip = foot + V(lean * std::cos(angle), lean * std::sin(angle), height);
        spot.rod(foot + V(0, 0, 0.36), tip, 0.008, leaf);
        spot.ellipsoid(tip, {0.07, 0.12, 0.03}, leaf);
    }
}

void addTable(const Spot& spot, const Materials& m, double x, double y) {
    spot.cylinder({x, y, 0}, 0.2, 0.03, m.dark);
    spot.cylinder({x, y, 0.03}, 0.03, 0.69, m.metal);
    spot.cylinder({x, y, 0.72}, 0.36, 0.03, m.wood);
    spot.cylinder({x + 0.1, y + 0.05, 0.75}, 0.05, 0.22, m.red, 1.5);
    spot.box({x - 0.2, y - 0.18, 0.75}, {x, y + 0.05, 0.79}, m.binder);
}

void addLockers(const Spot& spot, const Materials& m) {
    for (int i = 0; i < 4; ++i) {
        const double x = 0.2 + 0.42 * i;
        spot.box({x, -kHalfWidth, 0.1}, {x + 0.40, -kHalfWidth + 0.32, 1.9}, i % 2 ? m.red : m.grey);
        spot.box({x + 0.05, -kHalfWidth + 0.32, 1.55}, {x + 0.35, -kHalfWidth + 0.325, 1.7}, m.dark);
        spot.box({x + 0.05, -kHalfWidth + 0.32, 0.9}, {x + 0.08, -kHalfWidth + 0.34, 1.05}, m.metal);
    }
}

void addVendingMachine(SceneBuilder& b, const Spot& spot, const Materials& m) {
    const int front = b.material(Texture::kTiles, {0.20f, 0.45f, 0.62f}, {0.92f, 0.90f, 0.70f},
                                 {0.9f, 0.3f, 0.2f}, 0.18f, 0.6f);
    spot.box({0.4, -kHalfWidth, 0.05}, {1.2, -kHalfWidth + 0.36, 1.8}, m.dark);
    spot.sheet({0.72, -kHalfWidth + 0.365, 1.05}, 0.54, 1.3, V::UnitY(), front);
    spot.box({1.04, -kHalfWidth + 0.36, 1.0}, {1.16, -kHalfWidth + 0.38, 1.3}, m.metal);
}

}  // namespace

void addLandmarks(SceneBuilder& b, const Spot& spot, const Materials& m, int corner) {
    const Spot last_bay = spot.along(-kBay);
    if (corner == 0) {
        hang(spot, m, 0.1, 1.55, 1.1, 0.9, poster(b, 104));
        addPlant(b, spot, {1.62, -0.62, 0});
        last_bay.sheet({3.35, -kHalfWidth + 0.01, 1.6}, 0.6, 0.85, V::UnitY(), poster(b, 111));
    }
    if (corner == 1) {
        const int dial =
            b.material(Texture::kClock, {0.95f, 0.94f, 0.90f}, {0.10f, 0.10f, 0.12f}, {0.75f, 0.15f, 0.12f});
        hang(spot, m, -0.35, 1.75, 0.5, 0.5, dial);
        hang(spot, m, 0.45, 1.5, 0.6, 0.8, poster(b, 112));
        addTable(spot, m, 1.55, -0.55);
    }
    if (corner == 2) {
        addLockers(spot, m);
        hang(spot, m, 0.2, 1.5, 1.2, 0.7, poster(b, 121));
        last_bay.sheet({3.4, -kHalfWidth + 0.01, 1.65}, 0.7, 0.5, V::UnitY(), poster(b, 116));
    }
    if (corner == 3) {
        addVendingMachine(b, spot, m);
        hang(spot, m, 0.35, 1.6, 0.45, 0.6, poster(b, 126));
        hang(spot, m, -0.4, 1.6, 0.45, 0.6, poster(b, 110));
    }
}

}  // namespace roevo::simulator::block
