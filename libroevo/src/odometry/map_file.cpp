#include "map_file.h"

#include <cmath>
#include <istream>
#include <ostream>
#include <tuple>

#include "input/byte_stream.h"

namespace roevo {
namespace {

constexpr std::array<char, 8> kMagic = {'R', 'O', 'E', 'V', 'O', 'M', 'A', 'P'};
constexpr std::uint32_t kVersion = 1, kWithLens = 2;  // which is only written where it is needed

struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    std::uint64_t size = 0, checksum = 0;  ///< of the bytes after it
    auto fields() { return std::tie(magic, version, size, checksum); }
    static constexpr std::size_t kSize = 8 + 4 + 8 + 8;
};

/// FNV-1a: any change of one byte changes it.
std::uint64_t checksumOf(std::string_view bytes) {
    std::uint64_t sum = 0xCBF29CE484222325U;
    for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
    return sum;
}

/// At most so many bytes; memory grows with what is there.
std::string readBytes(std::istream& in, std::uint64_t count) {
    constexpr std::uint64_t kAtOnce = 1 << 20;
    std::string bytes;
    while (in && bytes.size() < count) {
        const std::size_t begin = bytes.size();
        bytes.resize(begin + static_cast<std::size_t>(std::min(kAtOnce, count - begin)));
        in.read(bytes.data() + begin, static_cast<std::streamsize>(bytes.size() - begin));
        bytes.resize(begin + static_cast<std::size_t>(in.gcount()));
    }
    return bytes;
}

}  // namespace

// What a map file has, in this order

template <class Bytes>
void transfer(Bytes& bytes, Pose& pose) {
    Eigen::Vector3d translation = pose.translation();
    Eigen::Vector4d rotation = pose.rotation().coeffs(), before = Eigen::Vector4d::Zero();
    // Until normalising it once more, as reading does, changes no bit
    for (int i = 0; i < 8 && rotation != before; ++i) {
        before = rotation;
        rotation.normalize();
    }
    bytes(rotation, translation);
    constexpr double kUnitLength = 1e-9;  // by which the square of the length may miss 1
    if (!(std::abs(rotation.squaredNorm() - 1) < kUnitLength)) throw std::runtime_error("a rotation is none");
    pose = Pose(Eigen::Quaterniond(rotation), translation);
}

/// What it has of each of these.
struct MapFormat {
    static auto of(PinholeCamera& c) {
        return std::tie(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.distortion);
    }
    static auto of(KeyframeInfo& k) { return std::tie(k.id, k.timestamp, k.T_world_camera); }
    static auto of(RelativePose& p) {
        return std::tie(p.keyframe, p.T_keyframe_camera, p.uncertainty.independent);
    }
    static auto of(PoseConstraint& c) { return std::tie(c.from, c.to, c.T_from_to, c.covariance); }
    static auto of(RowMotion& r) { return std::tie(r.velocity, r.turn, r.seconds_per_row, r.reference_row); }
    static auto of(CovisibilityGraph::Link& l) { return std::tie(l.edge, l.other_edge, l.points); }
    static auto of(CovisibilityGraph::Links& l) { return std::tie(l.other, l.links); }
    static auto of(KeptKeyframe& k) {
        return std::tie(k.points, k.median_depth, k.row_motion, k.found, k.verdicts, k.links);
    }
    static auto of(KeyframeGraph& g) {
        return std::tie(g.keyframes, g.links, g.covariances, g.related, g.loops);
    }
    static auto of(StoredMap& m) { return std::tie(m.camera, m.graph, m.places, m.edges, m.surfaces); }
};

template <class Bytes, class T>
void transfer(Bytes& bytes, T& value) {
    std::apply([&](auto&... fields) { bytes(fields...); }, MapFormat::of(value));
}

namespace {

/// Terms that version 1 has no place for.
bool hasOtherLens(const PinholeCamera& camera) {
    return camera.isRational() || camera.lens != LensModel::kBrownConrady;
}

template <class Bytes>
void transferOtherLens(Bytes& bytes, PinholeCamera& camera) {
    int model = static_cast<int>(camera.lens);
    bytes(camera.denominator, model);
    camera.lens = static_cast<LensModel>(model);
    if (model != static_cast<int>(LensModel::kBrownConrady) &&
        model != static_cast<int>(LensModel::kKannalaBrandt))
        throw std::runtime_error("its lens is of a kind that is not known");
}

}  // namespace

void writeMap(StoredMap map, std::ostream& out) {
    if (const std::string fault = faultOf(map); !fault.empty())
        throw std::runtime_error("there is no map to keep: " + fault);
    ByteWriter contents, head;
    Header header;
    contents(map);
    if (hasOtherLens(map.camera)) {
        header.version = kWithLens;
        transferOtherLens(contents, map.camera);
    }
    header.size = contents.bytes().size();
    header.checksum = checksumOf(contents.bytes());
    head(header);
    out << head.bytes() << contents.bytes();
}

StoredMap readMap(std::istream& in) {
    Header header;
    const std::string head = readBytes(in, Header::kSize);
    if (head.size() == Header::kSize) ByteReader{head}(header);
    if (head.size() != Header::kSize || header.magic != kMagic)
        throw std::runtime_error("this is no map of roevo");
    if (header.version != kVersion && header.version != kWithLens)
        throw std::runtime_error("the map is of version " + std::to_string(header.version) +
                                 ", and only versions " + std::to_string(kVersion) + " and " +
                                 std::to_string(kWithLens) + " can be read");
    const std::string contents = readBytes(in, header.size);
    if (contents.size() < header.size)
        throw std::runtime_error("the map is incomplete: it has " + std::to_string(contents.size()) + " of " +
                                 std::to_string(header.size) + " bytes");
    if (in.peek() != std::istream::traits_type::eof())
        throw std::runtime_error("the map is damaged: there is more after its end");
    if (checksumOf(contents) != header.checksum)
        throw std::runtime_error("the map is damaged: its checksum is wrong");
    StoredMap map;
    std::string fault;
    try {
        ByteReader reader(contents);
        reader(map);
        if (header.version == kWithLens) transferOtherLens(reader, map.camera);
        fault = reader.atEnd() ? faultOf(map) : "there is more in it than belongs there";
    } catch (const std::runtime_error& error) {
        fault = error.what();
    }
    if (!fault.empty()) throw std::runtime_error("the map is damaged: " + fault);
    return map;
}

}  // namespace roevo
