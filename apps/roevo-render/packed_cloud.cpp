#include "packed_cloud.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "input/byte_stream.h"
#include "programs/text.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

constexpr std::size_t kBlock = 1024;  // points that share a box: neighbours mostly, so that boxes are small
constexpr float kSteps = 65535;
constexpr float kFaintest = 0.35f;  // visibility of an edge with confidence 0

void packBlock(const Cloud& cloud, std::size_t begin, std::size_t end, ByteWriter& boxes,
               ByteWriter& positions) {
    Eigen::Vector3f low = cloud.positions[begin], high = low;
    for (std::size_t i = begin; i < end; ++i) {
        low = low.cwiseMin(cloud.positions[i]);
        high = high.cwiseMax(cloud.positions[i]);
    }
    float step = (high - low).maxCoeff() / kSteps;
    boxes(low, step);
    for (std::size_t i = begin; i < end; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const float steps = step > 0 ? (cloud.positions[i][axis] - low[axis]) / step : 0;
            auto place = static_cast<std::uint16_t>(std::clamp(std::round(steps), 0.f, kSteps));
            positions(place);
        }
}

}  // namespace

Cloud lineCloud(const EdgeMap& edges, bool pseudo, const Pose& T_scene_world) {
    const Eigen::Isometry3f T = T_scene_world.cast<float>();
    Cloud cloud;
    cloud.lines = true;
    for (const MapEdge& edge : edges) {
        if (isPseudo(edge.verdict) != pseudo) continue;
        const float gap = largestDrawnGap(edge.points);
        const float trust = pseudo ? 1 : kFaintest + (1 - kFaintest) * std::clamp(edge.confidence, 0.f, 1.f);
        for (std::size_t i = 0; i < edge.points.size(); ++i) {
            const bool joined = i > 0 && (edge.points[i] - edge.points[i - 1]).norm() < gap;
            const Rgb c = pseudo ? pseudoEdgeColour(edge.verdict) : edge.colours[i];
            cloud.positions.push_back(T * edge.points[i]);
            cloud.colours.push_back(
                {c[0], c[1], c[2], static_cast<std::uint8_t>(joined ? std::lround(255 * trust) : 0)});
        }
    }
    return cloud;
}

Cloud pointCloud(const std::vector<ColouredPoint>& points, const Pose& T_scene_world) {
    const Eigen::Isometry3f T = T_scene_world.cast<float>();
    Cloud cloud;
    for (const ColouredPoint& point : points) {
        cloud.positions.push_back(T * point.position);
        cloud.colours.push_back({point.colour[0], point.colour[1], point.colour[2], 255});
    }
    return cloud;
}

Cloud thinned(const Cloud& cloud, std::size_t k) {
    Cloud kept;
    kept.lines = cloud.lines;
    const auto begins = [&](std::size_t i) { return i == cloud.size() || cloud.colours[i][3] == 0; };
    std::size_t left_out = k;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool is_end = cloud.lines && (begins(i) || begins(i + 1));
        if (++left_out < k && !is_end) continue;
        left_out = 0;
        kept.positions.push_back(cloud.positions[i]);
        kept.colours.push_back(cloud.colours[i]);
    }
    return kept;
}

nlohmann::ordered_json packed(const Cloud& cloud) {
    ByteWriter boxes, positions, colours;
    for (std::size_t begin = 0; begin < cloud.size(); begin += kBlock)
        packBlock(cloud, begin, std::min(begin + kBlock, cloud.size()), boxes, positions);
    for (auto colour : cloud.colours) colours(colour);
    return {{"count", cloud.size()},
            {"block", kBlock},
            {"boxes", base64(boxes.bytes())},
            {"positions", base64(positions.bytes())},
            {"colours", base64(colours.bytes())}};
}

std::string packedFloats(const std::vector<float>& values) {
    ByteWriter bytes;
    for (float value : values) bytes(value);
    return base64(bytes.bytes());
}

}  // namespace roevo
