#include "block_pieces.h"
#include "block_way.h"

namespace roevo::simulator {
namespace block {
namespace {

Materials makeMaterials(SceneBuilder& b) {
    Materials m{};
    m.white = b.material(Texture::kPlain, {0.88f, 0.88f, 0.86f});
    m.grey = b.material(Texture::kPlain, {0.50f, 0.52f, 0.54f});
    m.dark = b.material(Texture::kPlain, {0.20f, 0.21f, 0.23f});
    m.metal = b.material(Texture::kPlain, {0.68f, 0.69f, 0.70f});
    m.lamp = b.material(Texture::kPlain, {0.98f, 0.98f, 0.95f}, kNone, kNone, 1, 1);
    m.red = b.material(Texture::kPlain, {0.72f, 0.12f, 0.10f});
    m.wood = b.material(Texture::kWood, {0.70f, 0.56f, 0.38f}, {0.54f, 0.40f, 0.25f});
    m.cloth = b.material(Texture::kFabric, {0.20f, 0.28f, 0.40f}, {0.30f, 0.38f, 0.50f}, kNone, 1.6f);
    m.door = b.material(Texture::kDoor, {0.66f, 0.58f, 0.46f}, {0.46f, 0.40f, 0.32f}, {0.80f, 0.74f, 0.64f});
    m.ceiling = b.material(Texture::kTiles, {0.90f, 0.90f, 0.88f}, {0.68f, 0.68f, 0.68f}, kNone, 0.5f);
    m.view = b.material(Texture::kWindowView, {0.45f, 0.65f, 0.90f}, {0.80f, 0.88f, 0.93f}, kNone, 1, 1);
    m.binder = b.material(Texture::kStripes, {0.18f, 0.24f, 0.34f}, {0.80f, 0.78f, 0.72f},
                          {0.60f, 0.16f, 0.14f}, 0.15f);
    m.picture =
        b.material(Texture::kPoster, {0.75f, 0.80f, 0.72f}, {0.20f, 0.40f, 0.44f}, {0.85f, 0.55f, 0.25f});
    return m;
}

}  // namespace
}  // namespace block

Scene makeBlock() {
    using namespace block;
    SceneBuilder b("block");
    const Materials m = makeMaterials(b);
    const int plaster = b.material(Texture::kPlaster, {0.84f, 0.80f, 0.70f}),
              green = b.material(Texture::kPlaster, {0.66f, 0.74f, 0.62f}),
              blue = b.material(Texture::kPlaster, {0.70f, 0.76f, 0.84f});
    const Style offices = {
        plaster,
        b.material(Texture::kStripes, {0.60f, 0.62f, 0.64f}, {0.52f, 0.54f, 0.58f}, {0.36f, 0.38f, 0.44f},
                   0.4f),
        b.material(Texture::kTiles, {0.58f, 0.56f, 0.52f}, {0.38f, 0.37f, 0.35f}, kNone, 0.5f)};
    const Style panelled = {green, m.wood,
                            b.material(Texture::kPlanks, {0.60f, 0.44f, 0.29f}, {0.42f, 0.29f, 0.18f})};
    const Style tiled = {
        blue, b.material(Texture::kTiles, {0.84f, 0.84f, 0.80f}, {0.36f, 0.44f, 0.52f}, kNone, 0.25f),
        b.material(Texture::kTiles, {0.40f, 0.36f, 0.36f}, {0.64f, 0.62f, 0.58f}, kNone, 0.33f)};

    // Counter-clockwise. The corridors along x are the same twice over, turned by half a turn, and within one
    // most bays are the same; only the corners tell them apart. Those along y differ in what they are made
    // of.
    const Style* const styles[] = {&offices, &panelled, &offices, &tiled};
    const V starts[] = {{kHalfWidth, 0, 0},
                        {kRingLength, kHalfWidth, 0},
                        {kRingLength - kHalfWidth, kRingWidth, 0},
                        {0, kRingWidth - kHalfWidth, 0}};
    for (int corridor = 0; corridor < 4; ++corridor) {
        const Style& style = *styles[corridor];
        const Spot start(b, starts[corridor], corridor);
        const int bays = corridor % 2 == 0 ? 4 : 3;
        for (int bay = 0; bay < bays; ++bay) {
            const Spot spot = start.along(kBay * bay);
            if (bay != 1)
                addDoors(spot, m, style);
            else if (corridor % 2 == 0)
                addOffice(spot, m, style);
            else
                addNiche(spot, m, style);
        }
        const Spot end = start.along(kBay * bays);
        const double side = 2 * kHalfWidth;
        end.sheet({kHalfWidth, 0, 0}, side, side, V::UnitZ(), style.floor);
        end.sheet({kHalfWidth, 0, kHeight}, side, side, -V::UnitZ(), m.ceiling);
        addWall(end, m, style, kOuter, 0, side);
        // The wall ahead is the outer wall of the corridor that begins here.
        const Spot next(b, end.toWorld({kHalfWidth, -kHalfWidth, 0}), corridor + 1);
        addWall(next, m, style, kOuter, 0, side);
        addLandmarks(b, end, m, corridor);
    }

    b.scene.light_spacing = 0.25;
    b.scene.ambient = 0.78f;
    // At opposite corners, so that the repeated corridors are lit alike as well.
    for (const V& lamp : {V(kRingLength, 0, 2.3), V(0, kRingWidth, 2.3)})
        b.scene.lights.push_back({lamp, 0.4f, 10.f, 0.6f, false, {1, 1, 0.97f}});

    b.scene.round_loop = roundTheBlock(true);
    b.scene.walk_loop = b.scene.handheld_loop = roundTheBlock(false);
    return b.scene;
}

}  // namespace roevo::simulator
