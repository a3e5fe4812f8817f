#include <cstdint>
#include <fstream>

#include "input/byte_stream.h"
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

void put(ByteWriter& vertices, Eigen::Vector3f position, Rgb colour) {
    vertices(position, colour);
}

bool writePly(const std::string& file, const std::string& comments, std::size_t count,
              const std::string& properties, const ByteWriter& vertices) {
    std::ofstream out(file, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\n"
        << comments << "element vertex " << count << '\n'
        << properties << "end_header\n"
        << vertices.bytes();
    out.close();
    return !out.fail();
}

bool writeEdges(const std::string& file, const EdgeMap& map) {
    ByteWriter vertices;
    std::size_t count = 0;
    std::int32_t number = 0;
    for (const MapEdge& edge : map) {
        for (std::size_t i = 0; i < edge.points.size(); i++, count++) {
            put(vertices, edge.points[i], edge.colours.at(i));
            vertices(edge.confidence, edge.views, edge.verdict, number);
        }
        number++;
    }
    return writePly(file, kEdgeComments, count, std::string(kPointProperties) + kEdgeProperties, vertices);
}

bool writePoints(const std::string& file, const std::vector<ColouredPoint>& points) {
    ByteWriter vertices;
    for (const ColouredPoint& point : points) put(vertices, point.position, point.colour);
    return writePly(file, kPointComments, points.size(), kPointProperties, vertices);
}

}  // namespace

void savePly(const std::string& file, const EdgeMap& map) {
    writeWholeFile(file, [&](const std::string& temporary) { return writeEdges(temporary, map); });
}

void savePointsPly(const std::string& file, const std::vector<ColouredPoint>& points) {
    writeWholeFile(file, [&](const std::string& temporary) { return writePoints(temporary, points); });
}

}  // namespace roevo
