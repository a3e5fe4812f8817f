#include <algorithm>

#include "block_pieces.h"

namespace roevo::simulator::block {
namespace {

/// A box that stands out from a corridor's wall by `depth`.
void slab(const Spot& spot, double side, double x0, double x1, double depth, double z0, double z1,
          int material) {
    const double wall = side * kHalfWidth, front = side * (kHalfWidth - depth);
    spot.box({x0, std::min(wall, front), z0}, {x1, std::max(wall, front), z1}, material);
}

/// What is left of a wall over an opening, and the opening's frame.
void addOpening(const Spot& spot, const Materials& m, const Style& style, double side, double x0, double x1,
                double top) {
    const double wall = side * kHalfWidth, frame = 0.08;
    addWall(spot, m, style, side, 0, x0);
    addWall(spot, m, style, side, x1, kBay);
    spot.sheet({0.5 * (x0 + x1), wall, 0.5 * (top + kHeight)}, x1 - x0, kHeight - top, {0, -side, 0},
               style.wall);
    for (const double x : {x0, x1 - frame}) slab(spot, side, x, x + frame, 0.04, 0, top, m.grey);
    slab(spot, side, x0 + frame, x1 - frame, 0.04, top - frame, top, m.grey);
}

/// Floor, ceiling and three walls of a recess that is as wide as from x0 to x1 and `depth` deep.
void addRecess(const Spot& spot, const Style& style, double side, double x0, double x1, double depth,
               double height, int floor, int ceiling) {
    const double near = side * kHalfWidth, far = side * (kHalfWidth + depth), middle = 0.5 * (near + far);
    const double x = 0.5 * (x0 + x1), z = 0.5 * height;
    spot.sheet({x, middle, 0}, x1 - x0, depth, V::UnitZ(), floor);
    spot.sheet({x, middle, height}, x1 - x0, depth, -V::UnitZ(), ceiling);
    spot.sheet({x, far, z}, x1 - x0, height, {0, -side, 0}, style.wall);
    spot.sheet({x0, middle, z}, depth, height, V::UnitX(), style.wall);
    spot.sheet({x1, middle, z}, depth, height, -V::UnitX(), style.wall);
}

void addWindow(const Spot& spot, const Materials& m, double x0, double x1, double y) {
    const double z0 = 0.9, z1 = 2.1;
    spot.sheet({0.5 * (x0 + x1), y + 0.005, 0.5 * (z0 + z1)}, x1 - x0, z1 - z0, V::UnitY(), m.view);
    for (const double z : {z0, z1}) spot.box({x0, y, z - 0.04}, {x1, y + 0.06, z + 0.04}, m.white);
    for (const double x : {x0, 0.5 * (x0 + x1), x1})
        spot.box({x - 0.04, y, z0 + 0.04}, {x + 0.04, y + 0.06, z1 - 0.04}, m.white);
}

void addDesk(const Spot& spot, const Materials& m, double x, double y) {
    spot.box({x - 0.7, y - 0.35, 0.71}, {x + 0.7, y + 0.35, 0.74}, m.wood);
    for (const double dx : {-0.65, 0.61})
        for (const double dy : {-0.32, 0.28})
            spot.box({x + dx, y + dy, 0}, {x + dx + 0.04, y + dy + 0.04, 0.71}, m.metal);
    spot.box({x - 0.25, y - 0.2, 0.86}, {x + 0.25, y - 0.17, 1.18}, m.dark);  // screen
    spot.box({x - 0.04, y - 0.19, 0.74}, {x + 0.04, y - 0.16, 0.86}, m.dark);
    spot.box({x - 0.22, y + 0.02, 0.74}, {x + 0.22, y + 0.16, 0.76}, m.white);  // keyboard
    spot.box({x - 0.25, y + 0.42, 0.42}, {x + 0.2, y + 0.85, 0.48}, m.cloth);   // chair
    spot.box({x - 0.25, y + 0.8, 0.55}, {x + 0.2, y + 0.85, 0.98}, m.cloth);
    spot.cylinder({x - 0.02, y + 0.63, 0}, 0.03, 0.42, m.metal);
    spot.cylinder({x - 0.02, y + 0.63, 0}, 0.22, 0.03, m.dark);
}

/// Binders on boards before the wall at `x`, open towards who comes along the corridor.
void addShelf(const Spot& spot, const Materials& m, double x, double y0, double y1) {
    for (const double y : {y0, y1}) spot.box({x - 0.3, y - 0.012, 0}, {x, y + 0.012, 1.7}, m.wood);
    for (int board = 0; board < 4; ++board) {
        const double z = 0.1 + 0.5 * board;
        spot.box({x - 0.3, y0, z - 0.02}, {x, y1, z}, m.wood);
        if (board < 3) spot.box({x - 0.25, y0 + 0.2, z}, {x, y1 - 0.03, z + 0.32}, m.binder);
    }
}

}  // namespace

void addShell(const Spot& spot, const Materials& m, const Style& style) {
    const double middle = 0.5 * kBay;
    spot.sheet({middle, 0, 0}, kBay, 2 * kHalfWidth, V::UnitZ(), style.floor);
    spot.sheet({middle, 0, kHeight}, kBay, 2 * kHalfWidth, -V::UnitZ(), m.ceiling);
    spot.box({middle - 0.6, -0.15, kHeight - 0.06}, {middle + 0.6, 0.15, kHeight - 0.01}, m.lamp)
        .casts_shadow = false;
    spot.box({kBay - 0.2, -kHalfWidth, 2.38}, {kBay, kHalfWidth, kHeight}, m.white);
    for (const double side : {kOuter, kInner}) slab(spot, side, kBay - 0.2, kBay, 0.1, 0, 2.38, m.white);
}

void addWall(const Spot& spot, const Materials& m, const Style& style, double side, double x0, double x1) {
    const double x = 0.5 * (x0 + x1), y = side * kHalfWidth, rail = 1.0;
    const V inward(0, -side, 0);
    spot.sheet({x, y, 0.5 * rail}, x1 - x0, rail, inward, style.dado);
    spot.sheet({x, y, 0.5 * (rail + kHeight)}, x1 - x0, kHeight - rail, inward, style.wall);
    slab(spot, side, x0, x1, 0.02, rail - 0.03, rail + 0.03, m.grey);
    slab(spot, side, x0, x1, 0.015, 0, 0.1, m.dark);
}

void addDoor(const Spot& spot, const Materials& m, double side, double x) {
    slab(spot, side, x - 0.55, x - 0.46, 0.06, 0, 2.14, m.grey);
    slab(spot, side, x + 0.46, x + 0.55, 0.06, 0, 2.14, m.grey);
    slab(spot, side, x - 0.46, x + 0.46, 0.06, 2.05, 2.14, m.grey);
    slab(spot, side, x - 0.46, x + 0.46, 0.03, 0, 2.05, m.door);
    slab(spot, side, x - 0.40, x - 0.26, 0.08, 1.02, 1.05, m.metal);   // handle
    slab(spot, side, x + 0.62, x + 0.78, 0.012, 1.50, 1.62, m.white);  // name plate
}

void addDoors(const Spot& spot, const Materials& m, const Style& style) {
    addShell(spot, m, style);
    for (const double side : {kOuter, kInner}) addWall(spot, m, style, side, 0, kBay);
    addDoor(spot, m, kOuter, 1.2);
    addDoor(spot, m, kInner, 2.5);
    spot.cylinder({2.9, -0.89, 0.75}, 0.08, 0.45, m.red);  // fire extinguisher
    spot.cylinder({2.9, -0.89, 1.20}, 0.03, 0.09, m.dark);
    slab(spot, kInner, 0.6, 1.4, 0.02, 1.3, 1.85, m.grey);  // notice board
    slab(spot, kInner, 0.7, 0.95, 0.025, 1.4, 1.75, m.white);
    slab(spot, kInner, 1.05, 1.3, 0.025, 1.4, 1.75, m.white);
}

void addOffice(const Spot& spot, const Materials& m, const Style& style) {
    constexpr double kDepth = 2.6, kBack = -kHalfWidth - kDepth;
    addShell(spot, m, style);
    addWall(spot, m, style, kInner, 0, kBay);
    addDoor(spot, m, kInner, 2.5);
    addOpening(spot, m, style, kOuter, 0.7, 3.3, 2.2);
    addRecess(spot, style, kOuter, 0.3, 3.6, kDepth, kHeight, style.floor, m.ceiling);
    addWindow(spot, m, 1.0, 3.0, kBack);
    addDesk(spot, m, 1.7, kBack + 0.9);
    addShelf(spot, m, 3.6, kBack + 0.7, kBack + 2.0);
}

void addNiche(const Spot& spot, const Materials& m, const Style& style) {
    constexpr double kDepth = 1.1, kBack = kHalfWidth + kDepth;
    addShell(spot, m, style);
    addWall(spot, m, style, kOuter, 0, kBay);
    addDoor(spot, m, kOuter, 1.2);
    addOpening(spot, m, style, kInner, 0.9, 3.1, 2.2);
    addRecess(spot, style, kInner, 0.9, 3.1, kDepth, 2.2, style.floor, m.white);
    spot.box({1.05, kBack - 0.5, 0.38}, {2.95, kBack - 0.05, 0.46}, m.cloth);  // bench
    for (const double x : {1.1, 2.85}) spot.box({x, kBack - 0.45, 0}, {x + 0.05, kBack - 0.1, 0.38}, m.dark);
    spot.box({1.1, kBack - 0.04, 1.62}, {2.9, kBack, 1.70}, m.wood);  // coat hooks
    for (int i = 0; i < 5; ++i)
        spot.box({1.28 + 0.35 * i, kBack - 0.1, 1.64}, {1.31 + 0.35 * i, kBack - 0.04, 1.67}, m.metal);
    spot.sheet({3.094, kBack - 0.55, 1.35}, 0.6, 0.8, -V::UnitX(), m.picture);
    spot.sheet({2.0, kBack - 0.006, 1.1}, 1.1, 0.6, -V::UnitY(), m.picture);
}

}  // namespace roevo::simulator::block
