#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "roevo_mrpt/scene_builder.h"
#include "whole_file.h"

namespace roevo {
namespace {

constexpr char kEdgeComments[] =
    "comment organized edges: the points of all edges, world frame, metres\n"
    "comment confidence, views, verdict and number are those of the edge that a point belongs to\n"
    "comment confidence: 0 to 1; views: keyframes that see the edge\n"
    "comment verdict: 0 unconfirmed, 1 true, 2 pseudo (spread), 3 pseudo (vanishing)\n"
    "comment edge: its number; the points of an edge follow one another along it\n";
constexpr char kPointComments[] = "comment surface points next to edges, world frame, metres\n";
constexpr char kPointProperties[] =
    "property float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n";
constexpr char kEdgeProperties[] =
    "property float confidence\nproperty int views\nproperty uchar verdict\nproperty int edge\n";

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
    std::array<char, 28> bytes_{};
    std::size_t used_ = 0;
};

void writeHeader(std::ostream& out, const std::string& comments, std::size_t count,
                 const std::string& properties) {
    out << "ply\nformat binary_little_endian 1.0\n"
        << comments << "element vertex " << count << '\n'
        << properties << "end_header\n";
}

void putPoint(Vertex& vertex, const Eigen::Vector3f& position, const Rgb& colour) {
    for (int axis = 0; axis < 3; axis++) vertex.put(position[axis]);
    for (const std::uint8_t channel : colour) vertex.put(channel);
}

bool writeEdges(const std::string& file, const EdgeMap& map) {
    std::size_t count = 0;
    for (const MapEdge& edge : map) count += edge.points.size();
    std::ofstream out(file, std::ios::binary);
    writeHeader(out, kEdgeComments, count, std::string(kPointProperties) + kEdgeProperties);
    Vertex vertex;
    std::int32_t number = -1;
    for (const MapEdge& edge : map) {
        number++;
        for (std::size_t i = 0; i < edge.points.size(); i++) {
            putPoint(vertex, edge.points[i], edge.colours.at(i));
            vertex.put(edge.confidence);
            vertex.put(static_cast<std::int32_t>(edge.views));
            vertex.put(static_cast<std::uint8_t>(edge.verdict));
            vertex.put(number);
            vertex.writeTo(out);
        }
    }
    out.close();
    return !out.fail();
}

bool writePoints(const std::string& file, const std::vector<ColouredPoint>& points) {
    std::ofstream out(file, std::ios::binary);
    writeHeader(out, kPointComments, points.size(), kPointProperties);
    Vertex vertex;
    for (const ColouredPoint& point : points) {
        putPoint(vertex, point.position, point.colour);
        vertex.writeTo(out);
    }
    out.close();
    return !out.fail();
}

}  // namespace

void savePly(const std::string& file, const EdgeMap& map) {
    writeWholeFile(file, [&](const std::string& temporary) { return writeEdges(temporary, map); });
}

void savePointsPly(const std::string& file, const std::vector<ColouredPoint>& points) {
    writeWholeFile(file, [&](const std::string& temporary) { return writePoints(temporary, points); });
}

}  // namespace roevo
