#pragma once
#include "scene_builder.h"

/// The pieces that scene_livingroom.cpp puts together.
namespace roevo::simulator::livingroom {

using V = Eigen::Vector3d;

constexpr double kWidth = 6.0, kDepth = 5.0, kHeight = 2.6;  // x (west to east), y (south to north), z

/// Indices of materials that several pieces share.
struct Materials {
    int light_wood, dark_wood, white, black, metal, brass, skirting;
};

void addBookcase(SceneBuilder& b, const Materials& m);
void addSofa(SceneBuilder& b, const Materials& m);
void addCoffeeTable(SceneBuilder& b, const Materials& m);
void addCabinet(SceneBuilder& b, const Materials& m);
void addTelevision(SceneBuilder& b, const Materials& m);
void addArmchairAndLamp(SceneBuilder& b, const Materials& m);
void addPlant(SceneBuilder& b);

}  // namespace roevo::simulator::livingroom
