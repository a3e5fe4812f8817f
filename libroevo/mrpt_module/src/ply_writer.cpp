#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "roevo_mrpt/scene_builder.h"
#include "whole_file.h"

namespace roevo {
namespace {

constexpr char kHeader[] =
    "comment organized edges: the points of all edges, world frame, metres\n"
    "comment confidence, views and verdict are those of the edge that a point belongs to\n"
    "comment confidence: 0 to 1; views: keyframes that see the edge\n"
    "comment verdict: 0 unconfirmed, 1 true, 2 pseudo (spread), 3 pseudo (vanishing)\n";
constexpr char kProperties[] =
    "property float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "property float confidence\nproperty int views\nproperty uchar verdict\n";

/// The bytes of one vertex, least significant first on any machine.
class Vertex {
  public:
    void put(std::uint8_t value) { bytes_.at(used_++) = static_cast<char>(value); }
    void put(std::int32_t value) { putBits(static_cast<std::uint32_t>(value)); }
    void put(float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        putBits(bits);
    }
    void writeTo(std::ostream& out) {
        out.write(bytes_.data(), static_cast<std::streamsize>(used_));
        used_ = 0;
    }

  private:
    void putBits(std::uint32_t bits) {
        for (int i = 0; i < 4; i++) put(static_cast<std::uint8_t>(bits >> (8 * i) & 0xffu));
    }
    std::array<char, 24> bytes_{};
    std::size_t used_ = 0;
};

bool writePly(const std::string& file, const EdgeMap& map) {
    std::size_t count = 0;
    for (const MapEdge& edge : map) count += edge.points.size();
    std::ofstream out(file, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\n"
        << kHeader << "element vertex " << count << '\n'
        << kProperties << "end_header\n";
    Vertex vertex;
    for (const MapEdge& edge : map)
        for (std::size_t i = 0; i < edge.points.size(); i++) {
            for (int axis = 0; axis < 3; axis++) vertex.put(edge.points[i][axis]);
            for (const std::uint8_t channel : edge.colours.at(i)) vertex.put(channel);
            vertex.put(edge.confidence);
            vertex.put(static_cast<std::int32_t>(edge.views));
            vertex.put(static_cast<std::uint8_t>(edge.verdict));
            vertex.writeTo(out);
        }
    out.close();
    return !out.fail();
}

}  // namespace

void savePly(const std::string& file, const EdgeMap& map) {
    writeWholeFile(file, [&](const std::string& temporary) { return writePly(temporary, map); });
}

}  // namespace roevo
