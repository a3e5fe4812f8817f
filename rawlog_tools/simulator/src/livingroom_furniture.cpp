#include "livingroom_furniture.h"

#include <cmath>

#include "random.h"

namespace roevo::simulator::livingroom {
namespace {

/// Books side by side on a board from x-like coordinate `from` to `to`; `place(along, size)` puts a book of
/// the given thickness, depth and height with its spine forward.
template <typename Place>
void rowOfBooks(SceneBuilder& b, double from, double to, double tallest, uint32_t seed, const Place& place) {
    static const Colour kCovers[] = {{0.60f, 0.14f, 0.12f}, {0.14f, 0.24f, 0.46f}, {0.12f, 0.36f, 0.24f},
                                     {0.82f, 0.74f, 0.58f}, {0.20f, 0.18f, 0.18f}, {0.80f, 0.52f, 0.16f},
                                     {0.38f, 0.20f, 0.36f}, {0.86f, 0.86f, 0.84f}, {0.26f, 0.46f, 0.58f},
                                     {0.54f, 0.36f, 0.22f}, {0.74f, 0.32f, 0.26f}, {0.46f, 0.52f, 0.30f}};
    double along = from;
    for (uint32_t i = 0;; ++i) {
        const double thickness = 0.02 + 0.035 * uniform(seed, i, 1);
        if (along + thickness > to) break;
        if (uniform(seed, i, 5) < 0.09) {  // a gap now and then
            along += 0.05 + 0.08 * uniform(seed, i, 6);
            continue;
        }
        const double height = tallest * (0.68 + 0.3 * uniform(seed, i, 2)),
                     depth = 0.15 + 0.06 * uniform(seed, i, 3);
        const Colour cover = kCovers[hashOf(seed, i, 4) % 12] * (0.85f + 0.3f * uniform(seed, i, 7));
        const bool pale = cover.sum() > 1.7f;
        const int book = b.material(Texture::kBook, cover,
                                    pale ? Colour(0.45f, 0.15f, 0.12f) : Colour(0.85f, 0.70f, 0.35f),
                                    pale ? Colour(0.25f, 0.25f, 0.35f) : Colour(0.92f, 0.90f, 0.84f));
        place(along + 0.5 * thickness, V(thickness - 0.001, depth, height), book);
        along += thickness;
    }
}

}  // namespace

void addBookcase(SceneBuilder& b, const Materials& m) {
    // East wall, open towards -x, from y = 2.3 to 4.5.
    const double x0 = kWidth - 0.32, x1 = kWidth, y0 = 2.3, y1 = 4.5, top = 2.0;
    b.box({x1 - 0.015, y0, 0}, {x1, y1, top}, m.light_wood);
    for (int i = 0; i <= 2; ++i) {
        const double y = y0 + 1.1 * i;
        b.box({x0, y - 0.0125, 0}, {x1 - 0.015, y + 0.0125, top}, m.light_wood);
    }
    for (int column = 0; column < 2; ++column) {
        const double from = y0 + 1.1 * column + 0.0125, to = from + 1.075;
        for (int shelf = 0; shelf <= 5; ++shelf) {
            const double z = shelf == 0 ? 0.06 : 0.06 + shelf * 0.384;
            b.box({x0 + 0.003, from, z - 0.022}, {x1 - 0.015, to, z}, m.light_wood);
            if (shelf == 5) continue;
            const auto seed = static_cast<uint32_t>(10 * column + shelf);
            double books_to = to - 0.02;
            if ((shelf + column) % 2 == 0) books_to -= 0.33;
            rowOfBooks(b, from + 0.01, books_to, 0.32, seed, [&](double y, const V& size, int book) {
                b.box({x0 + 0.05, y - 0.5 * size.x(), z},
                      {x0 + 0.05 + size.y(), y + 0.5 * size.x(), z + size.z()}, book);
            });
            if ((shelf + column) % 2 != 0) continue;
            const int vase = b.material(Texture::kStripes, {0.20f, 0.42f, 0.50f}, {0.88f, 0.84f, 0.74f},
                                        {0.65f, 0.28f, 0.20f}, 0.06f);
            if (shelf % 3 == 0) b.cylinder({x0 + 0.15, to - 0.16, z}, 0.05, 0.24, vase, 1.6);
            if (shelf % 3 == 1) b.ellipsoid({x0 + 0.15, to - 0.16, z + 0.10}, {0.1, 0.1, 0.1}, vase);
            if (shelf % 3 == 2)
                b.turnedBox({x0 + 0.14, to - 0.17, z + 0.11}, {0.14, 0.2, 0.22}, 0.3,
                            b.material(Texture::kPoster, {0.86f, 0.80f, 0.66f}, {0.70f, 0.25f, 0.20f},
                                       {0.2f, 0.4f, 0.5f}));
        }
    }
}

void addSofa(SceneBuilder& b, const Materials& m) {
    // West wall, seat towards +x, from y = 1.3 to 3.5.
    const int cloth = b.material(Texture::kFabric, {0.30f, 0.36f, 0.42f}, {0.40f, 0.47f, 0.53f}, kNone, 1.6f);
    const int seat = b.material(Texture::kFabric, {0.34f, 0.41f, 0.47f}, {0.46f, 0.53f, 0.58f}, kNone, 1.6f);
    const double y0 = 1.3, y1 = 3.5;
    b.box({0.10, y0 + 0.02, 0.10}, {0.92, y1 - 0.02, 0.28}, cloth);
    b.box({0.06, y0, 0.10}, {0.30, y1, 0.82}, cloth);
    b.box({0.06, y0, 0.10}, {0.94, y0 + 0.2, 0.60}, cloth);
    b.box({0.06, y1 - 0.2, 0.10}, {0.94, y1, 0.60}, cloth);
    for (int i = 0; i < 3; ++i) {
        const double y = y0 + 0.205 + 0.6 * i;
        b.box({0.30, y, 0.28}, {0.96, y + 0.59, 0.45}, seat);
        Primitive& back = b.box({0.28, y + 0.01, 0.44}, {0.44, y + 0.58, 0.88}, seat);
        back.R_world_object = Eigen::AngleAxisd(-0.14, V::UnitY()).toRotationMatrix();
    }
    const int red = b.material(Texture::kStripes, {0.72f, 0.20f, 0.16f}, {0.88f, 0.80f, 0.66f},
                               {0.25f, 0.12f, 0.12f}, 0.09f);
    const int mustard =
        b.material(Texture::kTiles, {0.84f, 0.62f, 0.18f}, {0.32f, 0.28f, 0.22f}, kNone, 0.07f);
    for (const auto& [y, yaw, material] : {std::tuple(1.72, 0.35, red), std::tuple(3.05, -0.3, mustard)}) {
        Primitive& cushion = b.turnedBox({0.54, y, 0.64}, {0.13, 0.42, 0.40}, yaw, material);
        cushion.R_world_object =
            cushion.R_world_object * Eigen::AngleAxisd(-0.35, V::UnitY()).toRotationMatrix();
    }
    for (const double x : {0.16, 0.86})
        for (const double y : {y0 + 0.1, y1 - 0.1}) b.cylinder({x, y, 0}, 0.025, 0.1, m.dark_wood);
}

void addCoffeeTable(SceneBuilder& b, const Materials& m) {
    const double x = 2.75, y = 2.45;
    b.box({x - 0.3, y - 0.55, 0.40}, {x + 0.3, y + 0.55, 0.435}, m.dark_wood);
    b.box({x - 0.27, y - 0.5, 0.14}, {x + 0.27, y + 0.5, 0.155}, m.dark_wood);
    for (const double dx : {-0.26, 0.26})
        for (const double dy : {-0.5, 0.5})
            b.box({x + dx - 0.02, y + dy - 0.02, 0.01}, {x + dx + 0.02, y + dy + 0.02, 0.40}, m.dark_wood);
    const int cover1 =
        b.material(Texture::kPoster, {0.12f, 0.30f, 0.36f}, {0.90f, 0.60f, 0.22f}, {0.85f, 0.82f, 0.74f});
    const int cover2 =
        b.material(Texture::kPoster, {0.90f, 0.86f, 0.78f}, {0.66f, 0.16f, 0.18f}, {0.2f, 0.3f, 0.5f});
    b.turnedBox({x - 0.02, y + 0.25, 0.445}, {0.22, 0.30, 0.02}, 0.25, cover1);
    b.turnedBox({x + 0.01, y + 0.24, 0.465}, {0.17, 0.24, 0.02}, -0.2, cover2);
    b.cylinder({x + 0.12, y - 0.10, 0.435}, 0.038, 0.095, m.white);
    const int bowl = b.material(Texture::kStripes, {0.16f, 0.30f, 0.50f}, {0.90f, 0.88f, 0.82f},
                                {0.16f, 0.30f, 0.50f}, 0.08f);
    b.cylinder({x - 0.06, y - 0.30, 0.435}, 0.07, 0.08, bowl, 2.0);
    const int orange = b.material(Texture::kPlain, {0.92f, 0.52f, 0.12f}),
              apple = b.material(Texture::kPlain, {0.62f, 0.16f, 0.12f});
    b.ellipsoid({x - 0.09, y - 0.28, 0.54}, {0.04, 0.04, 0.038}, orange);
    b.ellipsoid({x - 0.02, y - 0.31, 0.54}, {0.038, 0.038, 0.036}, apple);
    b.ellipsoid({x - 0.07, y - 0.35, 0.535}, {0.04, 0.04, 0.038}, orange);
    const int magazine =
        b.material(Texture::kPoster, {0.86f, 0.40f, 0.34f}, {0.15f, 0.2f, 0.35f}, {0.95f, 0.9f, 0.8f});
    b.turnedBox({x + 0.02, y, 0.165}, {0.21, 0.28, 0.02}, 0.1, magazine);
}

void addCabinet(SceneBuilder& b, const Materials& m) {
    // South wall: a sideboard with drawers and doors, x from 1.2 to 3.0.
    const double x0 = 1.2, x1 = 3.0, front = 0.45;
    b.box({x0, 0, 0.12}, {x1, front - 0.02, 0.80}, m.dark_wood);
    b.box({x0 - 0.02, 0, 0.80}, {x1 + 0.02, front, 0.83}, m.light_wood);
    for (const double x : {x0 + 0.05, x1 - 0.05})
        for (const double y : {0.05, front - 0.07}) b.cylinder({x, y, 0}, 0.022, 0.12, m.black);
    for (int column = 0; column < 3; ++column) {
        const double left = x0 + 0.02 + 0.59 * column;
        if (column == 1) {
            b.box({left, front - 0.02, 0.14}, {left + 0.57, front, 0.78}, m.light_wood);
            b.ellipsoid({left + 0.51, front + 0.015, 0.5}, {0.018, 0.018, 0.018}, m.brass);
            continue;
        }
        for (int drawer = 0; drawer < 3; ++drawer) {
            const double z = 0.14 + 0.215 * drawer;
            b.box({left, front - 0.02, z}, {left + 0.57, front, z + 0.205}, m.light_wood);
            b.rod({left + 0.2, front + 0.02, z + 0.12}, {left + 0.37, front + 0.02, z + 0.12}, 0.008,
                  m.brass);
        }
    }
    const int shade = b.material(Texture::kStripes, {0.95f, 0.86f, 0.66f}, {0.97f, 0.90f, 0.72f},
                                 {0.85f, 0.66f, 0.42f}, 0.12f, 0.55f);
    b.cylinder({1.45, 0.22, 0.83}, 0.08, 0.02, m.brass);
    b.cylinder({1.45, 0.22, 0.85}, 0.012, 0.26, m.brass);
    b.cylinder({1.45, 0.22, 1.08}, 0.15, 0.22, shade, 0.6);
    rowOfBooks(b, 2.0, 2.45, 0.28, 99, [&](double x, const V& size, int book) {
        b.box({x - 0.5 * size.x(), 0.12, 0.83}, {x + 0.5 * size.x(), 0.12 + size.y(), 0.83 + size.z()}, book);
    });
    b.turnedBox({2.75, 0.2, 0.93}, {0.24, 0.14, 0.2}, 0.2, m.black);
    b.turnedBox({2.75, 0.2, 0.93}, {0.2, 0.15, 0.16}, 0.2, m.metal);
}

void addTelevision(SceneBuilder& b, const Materials& m) {
    // East wall, y from 0.5 to 2.1.
    const int front = b.material(Texture::kWood, {0.62f, 0.50f, 0.36f}, {0.48f, 0.37f, 0.25f});
    b.box({kWidth - 0.42, 0.45, 0.08}, {kWidth, 2.05, 0.48}, m.white);
    for (int i = 0; i < 3; ++i) {
        b.box({kWidth - 0.44, 0.47 + 0.525 * i, 0.10}, {kWidth - 0.42, 0.47 + 0.525 * i + 0.51, 0.46}, front);
        b.rod({kWidth - 0.455, 0.62 + 0.525 * i, 0.42}, {kWidth - 0.455, 0.82 + 0.525 * i, 0.42}, 0.007,
              m.metal);
    }
    b.box({kWidth - 0.25, 0.62, 0.56}, {kWidth - 0.20, 1.82, 1.25}, m.black);
    b.box({kWidth - 0.3, 1.02, 0.48}, {kWidth - 0.14, 1.42, 0.495}, m.black);
    b.box({kWidth - 0.24, 1.17, 0.48}, {kWidth - 0.21, 1.27, 0.58}, m.black);
    const int screen = b.material(Texture::kPoster, {0.45f, 0.65f, 0.85f}, {0.92f, 0.72f, 0.45f},
                                  {0.18f, 0.25f, 0.22f}, 1, 0.8f);
    b.scene.materials[static_cast<size_t>(screen)].seed = 41;  // a landscape
    b.sheet({kWidth - 0.252, 1.22, 0.905}, 1.16, 0.65, -V::UnitX(), screen);
    b.box({kWidth - 0.36, 0.48, 0.48}, {kWidth - 0.14, 0.60, 0.80}, m.black);
    b.cylinder({kWidth - 0.36, 0.54, 0.72}, 0.01, 0.01, m.metal);
}

void addArmchairAndLamp(SceneBuilder& b, const Materials& m) {
    const V centre(4.75, 4.25, 0);
    const double yaw = -2.5;
    const int leather =
        b.material(Texture::kFabric, {0.52f, 0.30f, 0.16f}, {0.64f, 0.40f, 0.24f}, kNone, 3.f);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw, V::UnitZ()).toRotationMatrix();
    const auto part = [&](const V& at, const V& size, int material) {
        return &b.turnedBox(centre + turn * at, size, yaw, material);
    };
    part({0, 0, 0.28}, {0.72, 0.62, 0.26}, leather);
    part({-0.34, 0, 0.60}, {0.16, 0.76, 0.68}, leather);
    for (const double side : {-0.37, 0.37}) part({0.02, side, 0.40}, {0.74, 0.13, 0.44}, leather);
    part({0.02, 0, 0.44}, {0.62, 0.58, 0.1}, leather);
    for (const double x : {-0.3, 0.3})
        for (const double y : {-0.3, 0.3}) b.cylinder(centre + turn * V(x, y, 0), 0.02, 0.16, m.dark_wood);
    const int pillow =
        b.material(Texture::kCarpet, {0.16f, 0.34f, 0.36f}, {0.80f, 0.60f, 0.26f}, {0.90f, 0.86f, 0.76f});
    Primitive* cushion = part({-0.18, 0, 0.66}, {0.1, 0.4, 0.36}, pillow);
    cushion->R_world_object =
        cushion->R_world_object * Eigen::AngleAxisd(-0.3, V::UnitY()).toRotationMatrix();
    // Floor lamp in the south-west corner.
    const int shade = b.material(Texture::kPlaster, {0.96f, 0.90f, 0.76f}, kNone, kNone, 1, 0.5f);
    b.cylinder({0.45, 0.65, 0}, 0.15, 0.025, m.black);
    b.cylinder({0.45, 0.65, 0.025}, 0.013, 1.45, m.black);
    b.cylinder({0.45, 0.65, 1.42}, 0.21, 0.28, shade, 0.68);
}

void addPlant(SceneBuilder& b) {
    const V foot(0.5, 4.45, 0);
    const int pot = b.material(Texture::kStripes, {0.86f, 0.84f, 0.80f}, {0.80f, 0.78f, 0.74f},
                               {0.35f, 0.40f, 0.45f}, 0.16f);
    const int soil = b.material(Texture::kFabric, {0.16f, 0.11f, 0.08f}, {0.28f, 0.2f, 0.14f});
    const int leaf =
        b.material(Texture::kFoliage, {0.10f, 0.30f, 0.12f}, {0.25f, 0.48f, 0.18f}, {0.50f, 0.66f, 0.34f});
    const int stem = b.material(Texture::kPlain, {0.30f, 0.38f, 0.18f});
    b.cylinder(foot, 0.15, 0.34, pot, 1.25);
    b.cylinder(foot + V(0, 0, 0.335), 0.17, 0.01, soil);
    for (uint32_t i = 0; i < 14; ++i) {
        const double angle = 2.4 * i, lean = 0.12 + 0.2 * uniform(7, i, 1),
                     height = 0.75 + 0.75 * uniform(7, i, 2);
        const V tip = foot + V(lean * std::cos(angle), lean * std::sin(angle), height);
        b.rod(foot + V(0, 0, 0.34), tip, 0.006, stem);
        Primitive& blade = b.ellipsoid(tip + V(0.06 * std::cos(angle), 0.06 * std::sin(angle), 0.02),
                                       {0.15, 0.06, 0.008}, leaf);
        blade.R_world_object = (Eigen::AngleAxisd(angle, V::UnitZ()) *
                                Eigen::AngleAxisd(0.5 - 0.9 * uniform(7, i, 3), V::UnitY()) *
                                Eigen::AngleAxisd(0.5 * uniform(7, i, 4) - 0.25, V::UnitX()))
                                   .toRotationMatrix();
    }
}

}  // namespace roevo::simulator::livingroom
