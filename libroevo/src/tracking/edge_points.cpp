#include "tracking/edge_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edges/edge_depth.h"
#include "edges/edge_sides.h"
#include "tracking/robust.h"

namespace roevo {
namespace {

/// Depths around the points of one edge, m. Neighbours look at much the same pixels: every other one is
/// looked up, and between two that agree the line through their inverse depths tells.
/// @param pixels  of the points in the depth image
/// @param jump    relative step of depth beyond which two are of different surfaces
void depthsAlong(const std::vector<Eigen::Vector2d>& pixels, const ForegroundDepth& foreground, float jump,
                 std::vector<float>& depths) {
    const auto lookUp = [&](std::size_t k) {
        return foreground.at(static_cast<float>(pixels[k].x()), static_cast<float>(pixels[k].y()));
    };
    depths.resize(pixels.size());
    for (std::size_t k = 0; k < depths.size(); k += 2) depths[k] = lookUp(k);
    for (std::size_t k = 1; k < depths.size(); k += 2) {
        const float before = depths[k - 1], after = k + 1 < depths.size() ? depths[k + 1] : 0;
        const bool agree = before > 0 && std::abs(before - after) <= jump * std::min(before, after);
        depths[k] = agree ? 2 * before * after / (before + after) : lookUp(k);
    }
}

}  // namespace

float EdgePoints3D::medianDepth() const {
    if (size() == 0) return 0;
    std::vector<float> depths(points.z.begin(), points.z.begin() + static_cast<std::ptrdiff_t>(size()));
    return medianOf(depths);
}

double depthWeight(double depth, const SensorOptions& sensor) {
    return 1 / (1 + std::exp(sensor.depth_weight_k * (depth - (sensor.max_depth + sensor.min_depth) / 2)));
}

bool depthsAgree(double expected, double seen, const SensorOptions& sensor) {
    constexpr double kSigmas = 3, kFloor = 0.02;  // m: foregrounds are found differently from elsewhere
    const double difference = expected - seen, sigma = sensor.depthSigma(seen);
    return difference * difference < kSigmas * kSigmas * (2 * sigma * sigma + kFloor * kFloor);
}

EdgePoints3D liftEdges(const OrganizedEdges& edges, const cv::Mat& depth, const PinholeCamera& camera,
                       const RowMotion& rows, const EdgeOptions& edge_options, const SensorOptions& sensor) {
    const double scale = std::max(1.0, camera.pixelScale());
    const auto jump = static_cast<float>(edge_options.depth_jump);
    const ForegroundDepth foreground(depth, edge_options, sensor);
    const auto most_gap = static_cast<std::size_t>(std::lround(3 * scale));  // points without depth
    const auto least_piece = static_cast<std::size_t>(std::lround(5 * scale));
    EdgePoints3D out;
    // Of the points of one edge: where the lens put them, the depth of the patches there, and that corrected
    std::vector<Eigen::Vector2d> pixels;
    std::vector<float> patches, z;
    std::vector<std::size_t> piece;  // points of the piece being built
    for (int e = 0; e < edges.numEdges(); ++e) {
        const IndexRange own = edges.pointsOf(e);
        pixels.clear();
        for (std::size_t i = own.first; i < own.end; ++i)
            pixels.push_back(camera.distortPixel({edges.x[i], edges.y[i]}));
        depthsAlong(pixels, foreground, jump, patches);
        z = patches;
        if (edge_options.two_sided_depth) correctBySides(edges, own.first, pixels, depth, jump, scale, z);
        const auto endPiece = [&] {
            const auto points = std::exchange(piece, {});
            if (points.size() < least_piece) return;
            out.image.addEdge(edges, own.first, points);
            for (const std::size_t k : points) {
                const std::size_t i = own.first + k;
                const Eigen::Vector3d p =
                    rows.toReference(camera.backProject(edges.x[i], edges.y[i], z[k]), edges.y[i]);
                out.points.add(p);
                out.weight.push_back(static_cast<float>(depthWeight(p.z(), sensor)));
                out.correction.push_back(z[k] - patches[k]);
                out.source.push_back(static_cast<std::int32_t>(i));
            }
        };
        for (std::size_t k = 0; k < z.size(); ++k) {
            if (z[k] == 0) continue;
            if (!piece.empty()) {
                const float previous = z[piece.back()];
                const bool gap = k - piece.back() - 1 > most_gap;
                if (gap || std::abs(z[k] - previous) > jump * std::min(z[k], previous)) endPiece();
            }
            piece.push_back(k);
        }
        endPiece();
    }
    out.points.pad();
    return out;
}

}  // namespace roevo
