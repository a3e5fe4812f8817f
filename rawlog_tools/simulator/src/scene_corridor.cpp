#include <cmath>

#include "scene_builder.h"

namespace roevo::simulator {
namespace corridor {
namespace {

using V = Eigen::Vector3d;

constexpr double kLength = 40, kWidth = 2.4, kHeight = 2.7;  // x, y, z

struct Materials {
    int white, grey, dark, door, red, metal, lamp;
};

/// A door with its frame on the wall y = 0 (side = 1) or y = kWidth (side = -1).
void addDoor(SceneBuilder& b, const Materials& m, double x, double side) {
    const double wall = side > 0 ? 0 : kWidth;
    const auto slab = [&](double x0, double x1, double depth, double z0, double z1, int material) {
        b.box({x0, std::min(wall, wall + side * depth), z0}, {x1, std::max(wall, wall + side * depth), z1},
              material);
    };
    slab(x - 0.55, x - 0.46, 0.05, 0, 2.14, m.grey);
    slab(x + 0.46, x + 0.55, 0.05, 0, 2.14, m.grey);
    slab(x - 0.46, x + 0.46, 0.05, 2.05, 2.14, m.grey);
    slab(x - 0.46, x + 0.46, 0.01, 0.01, 2.05, m.door);
    b.rod({x - 0.38, wall + side * 0.06, 1.03}, {x - 0.26, wall + side * 0.06, 1.03}, 0.011, m.metal);
    slab(x + 0.62, x + 0.78, 0.012, 1.50, 1.62, m.metal);  // name plate
}

}  // namespace
}  // namespace corridor

Scene makeCorridor() {
    using namespace corridor;
    SceneBuilder b("corridor");
    Materials m{};
    m.white = b.material(Texture::kPlain, {0.86f, 0.86f, 0.84f});
    m.grey = b.material(Texture::kPlain, {0.52f, 0.54f, 0.56f});
    m.dark = b.material(Texture::kPlain, {0.25f, 0.26f, 0.28f});
    m.door = b.material(Texture::kPlain, {0.62f, 0.56f, 0.46f});
    m.red = b.material(Texture::kPlain, {0.72f, 0.12f, 0.10f});
    m.metal = b.material(Texture::kPlain, {0.72f, 0.73f, 0.74f});
    m.lamp = b.material(Texture::kPlain, {0.98f, 0.98f, 0.95f}, kNone, kNone, 1, 1);
    const int floor = b.material(Texture::kPlain, {0.46f, 0.47f, 0.46f});
    const int wall = b.material(Texture::kPlain, {0.80f, 0.79f, 0.75f});
    b.room({kLength, kWidth, kHeight}, floor, m.white, wall, wall, wall, wall);

    for (const double y : {0.0, kWidth - 0.015}) b.box({0, y, 0}, {kLength, y + 0.015, 0.1}, m.dark);
    for (const double x : {0.0, kLength - 0.015})
        b.box({x, 0.015, 0}, {x + 0.015, kWidth - 0.015, 0.1}, m.dark);
    for (int i = 0; i < 10; ++i) {
        // The rhythm is uneven, as in real buildings, so that no two stretches look alike.
        const double x = 1.9 + 4.0 * i + 0.35 * std::sin(2.1 * i);
        addDoor(b, m, x, 1);
        if (i < 9) addDoor(b, m, x + 1.6 + 0.3 * std::cos(1.3 * i), -1);
        b.box({x + 2.9, 0, 2.45}, {x + 3.1, kWidth, kHeight}, m.white);  // beam
        for (const double y : {0.0, kWidth - 0.12})
            b.box({x + 2.9, y, 0}, {x + 3.1, y + 0.12, 2.45}, m.white);
        b.box({x - 0.1, kWidth / 2 - 0.15, kHeight - 0.06}, {x + 1.1, kWidth / 2 + 0.15, kHeight - 0.01},
              m.lamp)
            .casts_shadow = false;
        if (i % 3 == 0) {
            b.cylinder({x + 2.2, 0.11, 0.75}, 0.08, 0.45, m.red);
            b.cylinder({x + 2.2, 0.11, 1.20}, 0.03, 0.09, m.dark);
        }
        if (i % 3 == 1)
            b.box({x + 1.3, 0, 1.1}, {x + 2.4, 0.03, 1.9}, m.grey),
                b.box({x + 1.34, 0.03, 1.14}, {x + 2.36, 0.032, 1.86}, m.white);
        if (i % 3 == 2) {
            b.box({x + 1.3, 0.1, 0.40}, {x + 2.5, 0.45, 0.45}, m.door);  // bench
            for (const double dx : {1.35, 2.4}) b.box({x + dx, 0.12, 0}, {x + dx + 0.05, 0.43, 0.40}, m.dark);
        }
        if (i % 2 == 0) {
            for (int rib = 0; rib < 6; ++rib)
                b.box({x + 0.05 + 0.1 * rib, kWidth - 0.1, 0.2}, {x + 0.12 + 0.1 * rib, kWidth - 0.03, 0.8},
                      m.white);
        } else {
            b.box({x - 0.2, kWidth - 0.25, 0}, {x + 0.3, kWidth, 0.9}, m.grey);  // locker
        }
    }
    // What is looked at while turning round at the far end.
    addDoor(b, m, kLength - 3.0, -1);
    b.cylinder({kLength - 1.45, kWidth - 0.11, 0.75}, 0.08, 0.45, m.red);
    b.box({kLength - 1.1, kWidth - 0.03, 1.1}, {kLength - 0.3, kWidth, 1.8}, m.grey);
    b.box({kLength - 1.06, kWidth - 0.032, 1.14}, {kLength - 0.34, kWidth - 0.03, 1.76}, m.white);
    b.rod({0, kWidth - 0.2, 2.6}, {kLength, kWidth - 0.2, 2.6}, 0.035, m.metal);  // pipe
    for (const double x : {0.0, kLength}) {
        const double out = x > 0 ? -0.04 : 0.04;
        for (const double y : {0.55, 1.75})
            b.box({std::min(x, x + out), y, 0}, {std::max(x, x + out), y + 0.1, 2.2}, m.grey);
        b.box({std::min(x, x + out), 0.55, 2.2}, {std::max(x, x + out), 1.85, 2.3}, m.grey);
        b.box({std::min(x, x + 0.3 * out), 0.65, 0}, {std::max(x, x + 0.3 * out), 1.75, 2.2}, m.door);
        b.box({std::min(x, x + 0.5 * out), 0.9, 1.3}, {std::max(x, x + 0.5 * out), 1.5, 1.9}, m.dark);
    }

    b.scene.light_spacing = 0.16;
    b.scene.ambient = 0.62f;
    for (const double x : {kLength / 6, kLength / 2, kLength * 5 / 6})
        b.scene.lights.push_back({{x, kWidth / 2, 2.4}, 0.55f, 12.f, 0.6f, false, {1, 1, 0.97f}});

    // Along one side, round at the end, back along the other. The sight sweeps from wall to wall as a
    // person's does.
    std::vector<Waypoint>& loop = b.scene.walk_loop;
    const double first = 2.5, last = kLength - 2.5, step = 2.5;
    int count = 0;
    for (double x = first; x <= last + 1e-9; x += step, ++count)
        loop.push_back(
            {{x, 0.95, 1.4 + 0.05 * std::sin(1.7 * count)}, {x + 3.0, count % 2 ? 0.35 : 2.05, 1.15}});
    loop.push_back({{last + 0.55, 1.15, 1.4}, {last + 1.9, 2.6, 1.1}});
    loop.push_back({{last + 0.45, 1.40, 1.4}, {last - 0.8, 2.9, 1.1}});
    for (double x = last; x >= first - 1e-9; x -= step, ++count)
        loop.push_back(
            {{x, 1.45, 1.4 + 0.05 * std::sin(1.7 * count)}, {x - 3.0, count % 2 ? 0.35 : 2.05, 1.15}});
    loop.push_back({{first - 0.55, 1.25, 1.4}, {first - 1.9, -0.2, 1.1}});
    loop.push_back({{first - 0.45, 1.00, 1.4}, {first + 0.8, -0.5, 1.1}});
    b.scene.handheld_loop = loop;
    return b.scene;
}

}  // namespace roevo::simulator
