#include <cmath>

#include "livingroom_furniture.h"

namespace roevo::simulator {
namespace livingroom {
namespace {

void addWindow(SceneBuilder& b, const Materials& m) {
    // North wall, x from 1.9 to 4.1.
    const double y = kDepth, x0 = 1.9, x1 = 4.1, z0 = 0.9, z1 = 2.2;
    const int view =
        b.material(Texture::kWindowView, {0.45f, 0.65f, 0.90f}, {0.80f, 0.88f, 0.93f}, kNone, 1, 1);
    b.sheet({0.5 * (x0 + x1), y - 0.004, 0.5 * (z0 + z1)}, x1 - x0, z1 - z0, -V::UnitY(), view);
    for (const double z : {z0, z1}) b.box({x0 - 0.04, y - 0.07, z - 0.04}, {x1 + 0.04, y, z + 0.04}, m.white);
    for (const double x : {x0, 0.5 * (x0 + x1), x1})
        b.box({x - 0.04, y - 0.07, z0 + 0.04}, {x + 0.04, y, z1 - 0.04}, m.white);
    b.box({x0 + 0.04, y - 0.035, 1.74}, {x1 - 0.04, y - 0.006, 1.77}, m.white);
    b.box({x0 - 0.1, y - 0.2, z0 - 0.075}, {x1 + 0.1, y, z0 - 0.04}, m.white);  // sill
    b.rod({x0 - 0.55, y - 0.13, 2.36}, {x1 + 0.55, y - 0.13, 2.36}, 0.014, m.brass);
    const int curtain = b.material(Texture::kStripes, {0.70f, 0.60f, 0.46f}, {0.78f, 0.70f, 0.58f},
                                   {0.50f, 0.34f, 0.26f}, 0.1f);
    for (int i = 0; i < 7; ++i) {
        for (const double start : {x0 - 0.48, x1 + 0.04}) {
            Primitive& fold = b.cylinder(
                {start + 0.035 + 0.07 * i, y - 0.13 + (i % 2 ? 0.012 : -0.012), 0.03}, 0.045, 2.32, curtain);
            fold.half_size.y() = 0.05;
        }
    }
    for (int i = 0; i < 11; ++i) {  // radiator
        const double x = 2.3 + 0.14 * i;
        b.box({x, y - 0.11, 0.14}, {x + 0.11, y - 0.03, 0.70}, m.white);
    }
    const int pot = b.material(Texture::kPlaster, {0.70f, 0.36f, 0.22f}),
              leaf = b.material(Texture::kFoliage, {0.16f, 0.36f, 0.14f}, {0.36f, 0.55f, 0.22f},
                                {0.55f, 0.7f, 0.35f});
    for (const double x : {2.25, 3.55}) {
        b.cylinder({x, y - 0.12, z0 - 0.04}, 0.05, 0.11, pot, 1.3);
        for (int i = 0; i < 7; ++i) {
            const double angle = 0.9 * i;
            b.rod({x, y - 0.12, z0 + 0.06},
                  {x + 0.1 * std::cos(angle), y - 0.13 + 0.07 * std::sin(angle), z0 + 0.18 + 0.02 * (i % 3)},
                  0.012, leaf);
        }
    }
}

void addWallDecoration(SceneBuilder& b, const Materials& m) {
    struct Picture {
        V centre;
        double width, height;
        V normal;
        int frame;
        uint32_t seed;
        Colour a, b, c;
    };
    const Picture pictures[] = {
        {{0, 2.4, 1.55},
         0.95,
         0.62,
         V::UnitX(),
         m.dark_wood,
         101,
         {0.62f, 0.72f, 0.82f},
         {0.92f, 0.74f, 0.56f},
         {0.16f, 0.22f, 0.28f}},
        {{0, 1.45, 1.62}, 0.36, 0.48, V::UnitX(), m.black, 104, kNone, kNone, kNone},
        {{0, 3.35, 1.62}, 0.40, 0.50, V::UnitX(), m.light_wood, 110, kNone, kNone, kNone},
        {{0, 3.95, 1.45},
         0.30,
         0.40,
         V::UnitX(),
         m.black,
         107,
         {0.92f, 0.86f, 0.72f},
         {0.75f, 0.25f, 0.18f},
         {0.15f, 0.35f, 0.42f}},
        {{2.15, 0, 1.65},
         0.60,
         0.84,
         V::UnitY(),
         m.black,
         111,
         {0.94f, 0.88f, 0.74f},
         {0.12f, 0.34f, 0.42f},
         {0.88f, 0.42f, 0.20f}},
        {{2.88, 0, 1.60}, 0.42, 0.56, V::UnitY(), m.light_wood, 112, kNone, kNone, kNone},
        {{0.95, 0, 1.70}, 0.36, 0.46, V::UnitY(), m.dark_wood, 118, kNone, kNone, kNone},
        {{1.0, kDepth, 1.60},
         0.50,
         0.70,
         -V::UnitY(),
         m.dark_wood,
         121,
         {0.80f, 0.70f, 0.62f},
         {0.86f, 0.82f, 0.66f},
         {0.28f, 0.24f, 0.34f}},
        {{5.2, kDepth, 1.60}, 0.56, 0.42, -V::UnitY(), m.black, 124, kNone, kNone, kNone},
        {{kWidth, 1.22, 1.82}, 0.90, 0.50, -V::UnitX(), m.black, 126, kNone, kNone, kNone},
    };
    for (const Picture& p : pictures) {
        const int picture = b.material(Texture::kPoster, p.a, p.b, p.c);
        b.scene.materials[static_cast<size_t>(picture)].seed = p.seed;
        b.framedPicture(p.centre, p.width, p.height, p.normal, p.frame, picture);
    }
    // Door in the south wall and a clock above the sideboard's end.
    const int door =
        b.material(Texture::kDoor, {0.86f, 0.84f, 0.79f}, {0.66f, 0.64f, 0.60f}, {0.95f, 0.94f, 0.90f});
    b.box({3.95, 0, 0}, {4.05, 0.03, 2.12}, m.white);
    b.box({4.95, 0, 0}, {5.05, 0.03, 2.12}, m.white);
    b.box({4.05, 0, 2.02}, {4.95, 0.03, 2.12}, m.white);
    b.box({4.05, 0, 0.01}, {4.95, 0.012, 2.02}, door);
    b.rod({4.13, 0.05, 1.03}, {4.25, 0.05, 1.03}, 0.01, m.brass);
    b.box({4.11, 0.012, 0.95}, {4.15, 0.02, 1.12}, m.brass);
    const int dial =
        b.material(Texture::kClock, {0.95f, 0.94f, 0.90f}, {0.10f, 0.10f, 0.12f}, {0.75f, 0.15f, 0.12f});
    b.sheet({3.5, 0.021, 1.85}, 0.32, 0.32, V::UnitY(), dial);
    b.box({3.32, 0, 1.67}, {3.68, 0.02, 2.03}, m.black);
    for (const auto& [low, high] :
         {std::pair(V(0, 0, 0), V(3.95, 0.012, 0.08)), std::pair(V(5.05, 0, 0), V(kWidth, 0.012, 0.08)),
          std::pair(V(0, kDepth - 0.012, 0), V(kWidth, kDepth, 0.08)),
          std::pair(V(0, 0.012, 0), V(0.012, kDepth - 0.012, 0.08)),
          std::pair(V(kWidth - 0.012, 0.012, 0), V(kWidth, kDepth - 0.012, 0.08))})
        b.box(low, high, m.skirting);
}

}  // namespace
}  // namespace livingroom

Scene makeLivingroom() {
    using namespace livingroom;
    SceneBuilder b("livingroom");
    Materials m{};
    m.light_wood = b.material(Texture::kWood, {0.76f, 0.62f, 0.44f}, {0.60f, 0.45f, 0.29f});
    m.dark_wood = b.material(Texture::kWood, {0.40f, 0.25f, 0.15f}, {0.26f, 0.15f, 0.09f});
    m.white = b.material(Texture::kPlain, {0.90f, 0.89f, 0.86f});
    m.black = b.material(Texture::kPlain, {0.09f, 0.09f, 0.10f});
    m.metal = b.material(Texture::kPlain, {0.60f, 0.61f, 0.63f});
    m.brass = b.material(Texture::kPlain, {0.66f, 0.52f, 0.26f});
    m.skirting = b.material(Texture::kPlain, {0.84f, 0.82f, 0.78f});
    const int floor = b.material(Texture::kPlanks, {0.66f, 0.48f, 0.31f}, {0.46f, 0.31f, 0.19f});
    const int ceiling = b.material(Texture::kPlaster, {0.93f, 0.92f, 0.90f});
    const int plain = b.material(Texture::kPlaster, {0.86f, 0.82f, 0.73f});
    const int accent = b.material(Texture::kPlaster, {0.46f, 0.58f, 0.56f});
    const int papered = b.material(Texture::kStripes, {0.84f, 0.78f, 0.68f}, {0.79f, 0.72f, 0.61f},
                                   {0.70f, 0.58f, 0.46f}, 0.22f);
    b.room({kWidth, kDepth, kHeight}, floor, ceiling, plain, plain, accent, papered);

    const int carpet =
        b.material(Texture::kCarpet, {0.52f, 0.13f, 0.12f}, {0.16f, 0.20f, 0.34f}, {0.84f, 0.74f, 0.54f});
    b.box({1.45, 1.15, 0}, {4.05, 3.75, 0.012}, carpet);
    addBookcase(b, m);
    addSofa(b, m);
    addCoffeeTable(b, m);
    addWindow(b, m);
    addCabinet(b, m);
    addTelevision(b, m);
    addArmchairAndLamp(b, m);
    addPlant(b);
    addWallDecoration(b, m);
    const int glass = b.material(Texture::kPlain, {0.98f, 0.95f, 0.86f}, kNone, kNone, 1, 0.8f);
    b.rod({3, 2.5, 2.3}, {3, 2.5, kHeight}, 0.008, m.black);
    b.ellipsoid({3, 2.5, 2.2}, {0.17, 0.17, 0.13}, glass).casts_shadow = false;

    b.scene.ambient = 0.60f;
    b.scene.lights = {{{3, 2.5, 2.2}, 0.62f, 4.0f, 0.17f, false, {1.0f, 0.96f, 0.88f}},
                      {{3.0, 4.4, 1.7}, 0.50f, 3.0f, 0.4f, false, {0.92f, 0.97f, 1.0f}},
                      {{0.7, 0.9, 1.75}, 0.40f, 1.6f, 0.12f, false, {1.0f, 0.88f, 0.70f}}};
    // Once around the table, looking across the room.
    b.scene.handheld_loop = {{{4.3, 1.5, 1.40}, {1.0, 2.9, 0.75}}, {{4.4, 2.3, 1.35}, {0.6, 2.6, 0.80}},
                             {{4.1, 3.1, 1.42}, {0.9, 1.4, 0.75}}, {{3.4, 3.7, 1.45}, {2.0, 0.3, 0.85}},
                             {{2.5, 3.7, 1.38}, {3.6, 0.3, 0.80}}, {{1.8, 3.2, 1.35}, {5.0, 0.8, 0.80}},
                             {{1.6, 2.4, 1.40}, {5.7, 2.2, 0.85}}, {{1.8, 1.7, 1.45}, {5.4, 3.7, 0.80}},
                             {{2.6, 1.2, 1.42}, {3.6, 4.7, 0.80}}, {{3.5, 1.1, 1.38}, {1.8, 4.2, 0.80}}};
    b.scene.walk_loop = {{{4.6, 1.2, 1.45}, {1.4, 3.4, 0.80}}, {{4.7, 2.2, 1.40}, {0.6, 2.5, 0.85}},
                         {{4.2, 3.2, 1.35}, {0.8, 1.2, 0.85}}, {{3.2, 3.9, 1.42}, {2.0, 0.3, 0.90}},
                         {{2.0, 3.9, 1.50}, {4.0, 0.4, 0.85}}, {{1.4, 3.0, 1.42}, {5.2, 0.9, 0.85}},
                         {{1.5, 1.9, 1.38}, {5.7, 2.6, 0.90}}, {{2.0, 1.1, 1.42}, {5.2, 3.9, 0.85}},
                         {{3.0, 0.9, 1.48}, {3.4, 4.8, 0.90}}, {{4.0, 0.9, 1.50}, {2.0, 4.4, 0.80}}};
    return b.scene;
}

}  // namespace roevo::simulator
