#pragma once
#include <string>

#include "roevo/odometry.h"

namespace roevo {

/// Odometry::loadMap() from a file, which errors name.
/// @return how many keyframes the map has
int loadMapFile(const std::string& file, Odometry& odometry, MapUse use = MapUse::kExtend);

/// Odometry::saveMap() into a file: the whole map, or what was there before.
/// @return how many keyframes the map has
/// @throws std::runtime_error, besides, when the file cannot be written
int saveMapFile(const Odometry& odometry, const std::string& file);

}  // namespace roevo
