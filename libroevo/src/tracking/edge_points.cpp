#include "roevo/tracking/edge_points.h"

#include <algorithm>
#include <cmath>

#include "roevo/edges/edge_depth.h"
#include "roevo/edges/edge_sides.h"
#include "roevo/tracking/kernels.h"

namespace roevo {

float EdgePoints3D::medianDepth() const {
    if (size() == 0) return 0;
    std::vector<float> depths(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(size()));
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
}

double depthWeight(double depth, const SensorOptions& sensor) {
    return 1 / (1 + std::exp(sensor.depth_weight_k * (depth - (sensor.max_depth + sensor.min_depth) / 2)));
}

EdgePoints3D liftEdges(const OrganizedEdges& edges, const cv::Mat& depth, const PinholeCamera& camera,
                       const RowMotion& rows, const EdgeOptions& edge_options, const SensorOptions& sensor) {
    constexpr int kMaxGap = 3;  // points without depth that an edge may bridge
    constexpr std::size_t kMinPiece = 5;
    EdgePoints3D out;
    out.image.clear();
    const bool distorted = camera.isDistorted();
    const auto jump = static_cast<float>(edge_options.depth_jump);

    EdgeSides sides;
    std::vector<float> edge_z, patch_z;  // of the points of one edge, with its sides and without
    std::vector<std::uint8_t> edge_occluding;
    std::vector<std::size_t> piece;  // indices into `edges` of the run being built
    std::vector<float> piece_z, piece_correction;
    std::vector<std::uint8_t> piece_occluding;
    const auto flush = [&] {
        if (piece.size() >= kMinPiece) {
            for (std::size_t k = 0; k < piece.size(); ++k) {
                const std::size_t i = piece[k];
                out.image.addPoint(edges.x[i], edges.y[i], edges.gradient_x[i], edges.gradient_y[i],
                                   edges.strength[i]);
                out.image.normal_x.push_back(edges.normal_x[i]);
                out.image.normal_y.push_back(edges.normal_y[i]);
                const Eigen::Vector3d p =
                    rows.toReference(camera.backProject(edges.x[i], edges.y[i], piece_z[k]), edges.y[i]);
                out.x.push_back(static_cast<float>(p.x()));
                out.y.push_back(static_cast<float>(p.y()));
                out.z.push_back(static_cast<float>(p.z()));
                out.weight.push_back(static_cast<float>(depthWeight(p.z(), sensor)));
                out.correction.push_back(piece_correction[k]);
                out.occluding.push_back(piece_occluding[k]);
            }
            out.image.finishEdge();
        }
        piece.clear();
        piece_z.clear();
        piece_correction.clear();
        piece_occluding.clear();
    };
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto first = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e)]);
        const auto end = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e) + 1]);
        edge_z.clear();
        edge_occluding.clear();
        for (std::size_t i = first; i < end; ++i) {
            Eigen::Vector2d pixel(edges.x[i], edges.y[i]);
            if (distorted) pixel = camera.distortPixel(pixel);
            const EdgeDepth found = foregroundDepth(depth, static_cast<float>(pixel.x()),
                                                    static_cast<float>(pixel.y()), edge_options, sensor);
            edge_z.push_back(found.depth);
            edge_occluding.push_back(found.occluding ? 1 : 0);
        }
        patch_z = edge_z;
        if (edge_options.two_sided_depth)
            sides.correct(edges, first, end, depth, camera, edge_options, edge_z);
        for (std::size_t i = first; i < end; ++i) {
            const float z = edge_z[i - first];
            if (z == 0) continue;
            if (!piece.empty()) {
                const float previous = piece_z.back();
                const bool gap = i - piece.back() - 1 > kMaxGap;
                if (gap || std::abs(z - previous) > jump * std::min(z, previous)) flush();
            }
            piece.push_back(i);
            piece_z.push_back(z);
            piece_correction.push_back(z - patch_z[i - first]);
            piece_occluding.push_back(edge_occluding[i - first]);
        }
        flush();
    }
    const std::size_t padded = kernels::paddedSize(out.size());
    out.x.resize(padded, 0);
    out.y.resize(padded, 0);
    out.z.resize(padded, 1);
    return out;
}

}  // namespace roevo
