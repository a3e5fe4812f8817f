#include "scene_builder.h"

namespace roevo::simulator {

using V = Eigen::Vector3d;

Scene makeShadows() {
    SceneBuilder b("shadows");
    const int floor = b.material(Texture::kPlain, {0.60f, 0.56f, 0.50f});
    const int wall = b.material(Texture::kPlain, {0.84f, 0.83f, 0.79f});
    const int wood = b.material(Texture::kPlain, {0.55f, 0.40f, 0.26f}),
              dark = b.material(Texture::kPlain, {0.22f, 0.22f, 0.25f});
    const int blue = b.material(Texture::kPlain, {0.24f, 0.36f, 0.52f}),
              white = b.material(Texture::kPlain, {0.90f, 0.90f, 0.88f});
    const int green = b.material(Texture::kPlain, {0.30f, 0.46f, 0.32f}),
              red = b.material(Texture::kPlain, {0.66f, 0.22f, 0.18f});
    b.room({5, 4.5, 2.8}, floor, wall, wall, wall, wall, wall);
    for (const double y : {0.0, 4.485}) b.box({0, y, 0}, {5, y + 0.015, 0.1}, dark);
    for (const double x : {0.0, 4.985}) b.box({x, 0.015, 0}, {x + 0.015, 4.485, 0.1}, dark);
    // Table with a box and a ball, on the north side.
    b.box({1.7, 3.2, 0.70}, {3.1, 4.0, 0.74}, wood);
    for (const double x : {1.75, 3.0})
        for (const double y : {3.25, 3.9}) b.box({x, y, 0}, {x + 0.05, y + 0.05, 0.70}, wood);
    b.turnedBox({2.1, 3.65, 0.86}, {0.28, 0.2, 0.24}, 0.5, blue);
    b.ellipsoid({2.75, 3.55, 0.85}, {0.11, 0.11, 0.11}, red);
    // Shelf with boxes on the west wall, chest and pillar in the corners, a door, frames.
    b.box({0, 1.4, 1.20}, {0.28, 3.0, 1.23}, wood);
    b.box({0.03, 1.55, 1.23}, {0.22, 1.80, 1.50}, green);
    b.box({0.03, 2.3, 1.23}, {0.20, 2.75, 1.38}, red);
    b.box({0, 1.6, 0}, {0.45, 2.9, 0.55}, dark);
    b.turnedBox({4.35, 3.85, 0.45}, {0.8, 0.6, 0.9}, 0.25, blue);
    b.cylinder({4.4, 0.7, 0}, 0.22, 1.1, green);
    b.box({1.2, 0, 0}, {1.29, 0.05, 2.1}, white);
    b.box({2.2, 0, 0}, {2.29, 0.05, 2.1}, white);
    b.box({1.2, 0, 2.1}, {2.29, 0.05, 2.19}, white);
    b.box({1.29, 0, 0.01}, {2.2, 0.01, 2.1}, wood);
    b.box({3.0, 0, 0.3}, {4.0, 0.3, 0.9}, wood);
    b.box({4.97, 1.6, 1.1}, {5, 2.7, 1.9}, dark);
    b.box({4.96, 1.66, 1.16}, {4.97, 2.64, 1.84}, white);
    b.box({2.0, 4.46, 1.3}, {2.8, 4.5, 1.9}, dark);
    b.box({2.06, 4.45, 1.36}, {2.74, 4.46, 1.84}, white);

    // What throws the moving shadows hangs between lamp and picture, out of sight.
    b.scene.motions = {{{0.32, 0, 0}, {0, 0.32, 0}, 0.55, 0},
                       {{0.28, 0.20, 0}, {0, 0, 0}, 0.9, 1.0},
                       {{0, 0.35, 0}, {0.10, 0, 0}, 0.7, 2.2}};
    Primitive* casters[3];
    b.scene.primitives.reserve(b.scene.primitives.size() + 3);
    casters[0] = &b.ellipsoid({2.5, 2.2, 2.30}, {0.11, 0.11, 0.11}, white);
    casters[1] = &b.turnedBox({2.5, 2.2, 2.15}, {0.5, 0.07, 0.04}, 0.6, white);
    casters[2] = &b.turnedBox({2.5, 2.2, 2.22}, {0.16, 0.22, 0.03}, 1.2, white);
    for (int i = 0; i < 3; ++i) {
        casters[i]->motion = i;
        casters[i]->visible = false;
    }
    b.scene.ambient = 0.50f;
    b.scene.lights = {{{2.5, 2.2, 2.65}, 0.80f, 4.5f, 0.05f, true, {1.0f, 0.97f, 0.9f}}};
    b.scene.handheld_loop = {{{3.6, 1.6, 1.35}, {1.5, 3.4, 0.85}}, {{3.6, 2.2, 1.40}, {0.8, 3.0, 0.85}},
                             {{3.3, 2.8, 1.35}, {0.4, 1.7, 0.80}}, {{2.6, 3.0, 1.42}, {1.4, 0.4, 0.85}},
                             {{1.9, 2.8, 1.38}, {3.2, 0.3, 0.80}}, {{1.5, 2.3, 1.35}, {4.7, 1.2, 0.80}},
                             {{1.4, 1.7, 1.40}, {4.6, 3.2, 0.85}}, {{1.9, 1.2, 1.35}, {3.6, 4.1, 0.85}},
                             {{2.8, 1.1, 1.38}, {2.2, 4.2, 0.85}}};
    b.scene.walk_loop = b.scene.handheld_loop;
    return b.scene;
}

}  // namespace roevo::simulator
