#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "roevo/edge_map.h"

namespace roevo {

/// Points for the page, in scene axes.
struct Cloud {
    std::vector<Eigen::Vector3f> positions;  ///< m
    /// Red, green, blue, and how visible the line is that ends in the point, 0: none does. Single points:
    /// 255.
    std::vector<std::array<std::uint8_t, 4>> colours;
    bool lines = false;

    std::size_t size() const { return positions.size(); }
};

/// Edges as lines: those that are pseudo-edges, or the others, which are fainter the less the map trusts
/// them.
Cloud lineCloud(const EdgeMap& edges, bool pseudo, const Pose& T_scene_world);

Cloud pointCloud(const std::vector<ColouredPoint>& points, const Pose& T_scene_world);

/// Every k-th point. The ends of lines stay.
Cloud thinned(const Cloud& cloud, std::size_t k);

/// About how many bytes of text a point takes when packed.
constexpr double kBytesPerPoint = 13.5;

/// {"count", "block", "boxes", "positions", "colours"}, the last three as base64, numbers with the least
/// significant byte first. Each block of points has a box of its own (float32: low x, y, z, and the step) and
/// each point its place in there (3 x uint16, in steps): coordinates err by half a step, 1/131070 of the
/// box's longest side.
nlohmann::ordered_json packed(const Cloud& cloud);

/// Numbers as base64 of float32, least significant byte first.
std::string packedFloats(const std::vector<float>& values);

}  // namespace roevo
