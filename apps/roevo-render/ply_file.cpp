#include "ply_file.h"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "input/byte_stream.h"
#include "input/excerpt.h"
#include "input/regular_file.h"

namespace roevo {
namespace {

const std::map<std::string, std::size_t> kTypeSizes = {{"uchar", 1}, {"int", 4}, {"float", 4}};

std::string readWhole(const std::string& path) {
    requireRegularInput(path);
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    std::ostringstream bytes;
    if (in) bytes << in.rdbuf();
    if (!in) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno ? errno : EIO));
    return bytes.str();
}

}  // namespace

void PlyFile::fail(const std::string& what) const {
    throw std::runtime_error(path_ + " is no map of roevo-odometry: " + what);
}

// Returns where the vertices begin.
std::size_t PlyFile::readHead() {
    const std::string end = "end_header\n";
    const std::size_t at = bytes_.find(end);
    if (bytes_.rfind("ply\nformat binary_little_endian 1.0\n", 0) != 0 || at == std::string::npos)
        fail("it has not the head of a binary PLY file");
    std::istringstream head(bytes_.substr(0, at));
    for (std::string line; std::getline(head, line);) {
        std::istringstream words(line);
        std::string kind, type, name;
        words >> kind >> type >> name;
        if (kind == "element") {
            const char* const end_of_count = name.data() + name.size();
            const auto [rest, error] = std::from_chars(name.data(), end_of_count, size_);
            if (type != "vertex" || stride_ > 0 || error != std::errc() || rest != end_of_count)
                fail("its head says '" + excerpt(line) + "'");
        } else if (kind == "property") {
            if (kTypeSizes.count(type) == 0) fail("its head says '" + excerpt(line) + "'");
            properties_[name] = {type, stride_};
            stride_ += kTypeSizes.at(type);
        }
    }
    return at + end.size();
}

PlyFile::PlyFile(const std::string& path) : path_(path), bytes_(readWhole(path)) {
    begin_ = readHead();
    position_ = offsetOf("x", "float");
    colour_ = offsetOf("red", "uchar");
    if (offsetOf("y", "float") != position_ + 4 || offsetOf("z", "float") != position_ + 8 ||
        offsetOf("green", "uchar") != colour_ + 1 || offsetOf("blue", "uchar") != colour_ + 2)
        fail("x, y, z or red, green, blue do not follow one another");
    const std::size_t held = bytes_.size() - begin_;
    if (held % stride_ != 0 || held / stride_ != size_)
        fail("its " + std::to_string(size_) + " points would be " + std::to_string(stride_) +
             " bytes each, but it has " + std::to_string(held) + " in all; is it cut off?");
}

std::size_t PlyFile::offsetOf(const std::string& property, const std::string& type) const {
    const auto found = properties_.find(property);
    if (found == properties_.end() || found->second.type != type)
        fail("its points have no '" + type + " " + property +
             "'; if an older version wrote it, run the odometry again");
    return found->second.offset;
}

template <class Value>
Value PlyFile::get(std::size_t vertex, std::size_t offset) const {
    Value value{};
    ByteReader(std::string_view(bytes_).substr(begin_ + vertex * stride_ + offset))(value);
    return value;
}

Eigen::Vector3f PlyFile::position(std::size_t vertex) const {
    const auto p = get<Eigen::Vector3f>(vertex, position_);
    if (!p.allFinite()) fail("point " + std::to_string(vertex) + " is not finite");
    return p;
}

Rgb PlyFile::colour(std::size_t vertex) const {
    return get<Rgb>(vertex, colour_);
}

EdgeMap readEdgesPly(const std::string& path) {
    const PlyFile ply(path);
    const std::size_t number_at = ply.offsetOf("edge", "int"), views_at = ply.offsetOf("views", "int"),
                      confidence_at = ply.offsetOf("confidence", "float"),
                      verdict_at = ply.offsetOf("verdict", "uchar");
    EdgeMap map;
    std::int32_t last = 0;
    for (std::size_t i = 0; i < ply.size(); ++i) {
        const auto number = ply.get<std::int32_t>(i, number_at);
        if (map.empty() || number != last) {
            MapEdge edge;
            edge.views = ply.get<std::int32_t>(i, views_at);
            edge.confidence = ply.get<float>(i, confidence_at);
            edge.verdict = static_cast<EdgeVerdict>(ply.get<std::uint8_t>(i, verdict_at));
            map.push_back(edge);
        }
        last = number;
        map.back().points.push_back(ply.position(i));
        map.back().colours.push_back(ply.colour(i));
    }
    return map;
}

std::vector<ColouredPoint> readPointsPly(const std::string& path) {
    const PlyFile ply(path);
    std::vector<ColouredPoint> points;
    points.reserve(ply.size());
    for (std::size_t i = 0; i < ply.size(); ++i) points.push_back({ply.position(i), ply.colour(i)});
    return points;
}

}  // namespace roevo
