#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "roevo_mrpt/scene_builder.h"
#include "whole_file.h"

namespace roevo {
namespace {

constexpr std::size_t kVertexBytes = 3 * sizeof(float) + 3;

/// The float's bytes, least significant first, on any machine.
void putLittleEndian(float value, char* out) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++) out[i] = static_cast<char>(bits >> (8 * i) & 0xffu);
}

bool writePly(const std::string& file, const EdgeMap& map) {
    std::size_t count = 0;
    for (const MapEdge& edge : map) count += edge.points.size();
    std::ofstream out(file, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\ncomment organized edges, world frame, metres\nelement "
           "vertex "
        << count
        << "\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    std::array<char, kVertexBytes> vertex{};
    for (const MapEdge& edge : map)
        for (std::size_t i = 0; i < edge.points.size(); i++) {
            for (int axis = 0; axis < 3; axis++)
                putLittleEndian(edge.points[i][axis], &vertex[4 * static_cast<std::size_t>(axis)]);
            for (std::size_t channel = 0; channel < 3; channel++)
                vertex[12 + channel] = static_cast<char>(edge.colours.at(i)[channel]);
            out.write(vertex.data(), vertex.size());
        }
    out.close();
    return !out.fail();
}

}  // namespace

void savePly(const std::string& file, const EdgeMap& map) {
    writeWholeFile(file, [&](const std::string& temporary) { return writePly(temporary, map); });
}

}  // namespace roevo
