#pragma once
#include "block_spot.h"

/// The pieces that scene_block.cpp puts together.
namespace roevo::simulator::block {

constexpr double kHalfWidth = 1.0, kHeight = 2.6;  // of a corridor
constexpr double kBay = 4.0;                       // length of what is between two beams
constexpr double kOuter = -1, kInner = 1;          // sides of a corridor

/// Indices of materials that several pieces share.
struct Materials {
    int white, grey, dark, metal, lamp, red, wood, cloth, door, ceiling, view, binder, picture;
};

/// What the walls and the floor of one corridor are made of.
struct Style {
    int wall, dado, floor;
};

/// Floor, ceiling and lamp of a bay, and the beam at its end.
void addShell(const Spot& spot, const Materials& m, const Style& style);
/// Wall from x0 to x1, with dado, rail and skirting.
void addWall(const Spot& spot, const Materials& m, const Style& style, double side, double x0, double x1);
void addDoor(const Spot& spot, const Materials& m, double side, double x);

/// A bay with a door on either side.
void addDoors(const Spot& spot, const Materials& m, const Style& style);
/// A bay with an open office on the outer side.
void addOffice(const Spot& spot, const Materials& m, const Style& style);
/// A bay with a place to sit, set back into the inner side.
void addNiche(const Spot& spot, const Materials& m, const Style& style);

/// What is to be seen at one place only: at the corner that the way comes to after each corridor (0..3), and
/// on the last bay's wall before it. @param spot  where the corridor ends
void addLandmarks(SceneBuilder& b, const Spot& spot, const Materials& m, int corner);

}  // namespace roevo::simulator::block
