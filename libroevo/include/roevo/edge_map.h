#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

using Rgb = std::array<std::uint8_t, 3>;

/// What mapping thinks of an edge.
enum class EdgeVerdict : std::uint8_t {
    kUnconfirmed,  ///< seen by one keyframe so far
    kTrue,         ///< seen by several keyframes at one place
    kSpread,       ///< pseudo-edge: its observations do not agree on a place (moving shadow, reflection)
    kVanishing     ///< pseudo-edge: most keyframes that look at its place do not see it (occlusion border)
};
const char* toString(EdgeVerdict verdict);
inline bool isPseudo(EdgeVerdict verdict) {
    return verdict == EdgeVerdict::kSpread || verdict == EdgeVerdict::kVanishing;
}

/// Why the map left a keyframe where it was.
struct MapRefusal {
    enum class Kind { kFewObservations, kMovedTooFar };
    Kind kind = Kind::kFewObservations;
    int keyframe = 0;
    int observations = 0;          ///< that fit the map
    double moved = 0, turned = 0;  ///< m and degrees, by which bundle adjustment would have moved it
};
/// In words, without and with the keyframe and the numbers.
const char* toString(MapRefusal::Kind kind);
std::string describe(const MapRefusal& refusal);

/// An organized edge of the map: points in order along the edge, world frame, metres.
struct MapEdge {
    std::vector<Eigen::Vector3f> points;
    std::vector<Rgb> colours;  ///< of the image, one per point
    int keyframe_id = 0;       ///< keyframe whose edge its first point is of, as a rule the longest
    int cluster = 0;           ///< edges of different keyframes that show the same edge have the same number
    int views = 1;             ///< keyframes that see it
    EdgeVerdict verdict = EdgeVerdict::kUnconfirmed;
    float confidence = 1;  ///< 0..1
};

using EdgeMap = std::vector<MapEdge>;

/// A point of a surface with the colour that the image has there.
struct ColouredPoint {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< m
    Rgb colour{};
};

}  // namespace roevo
