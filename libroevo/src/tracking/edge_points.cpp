#include "tracking/edge_points.h"

#include <algorithm>
#include <cmath>

#include "edges/edge_depth.h"
#include "edges/edge_sides.h"
#include "tracking/kernels.h"

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
    const double scale = std::max(1.0, camera.pixelScale());
    const auto most_gap =
        static_cast<std::size_t>(std::lround(3 * scale));  // without depth, that an edge may bridge
    const auto least_piece = static_cast<std::size_t>(std::lround(5 * scale));
    EdgePoints3D out;
    out.image.clear();
    const bool distorted = camera.isDistorted();
    const auto jump = static_cast<float>(edge_options.depth_jump);

    EdgeSides sides;
    // Of the points of one edge: where the lens put them, their patch's depth, and that corrected by the
    // sides
    std::vector<Eigen::Vector2d> pixels;
    std::vector<float> patch_z, z;
    std::vector<std::uint8_t> occluding;
    std::vector<std::size_t> piece;  // points of the run being built
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto first = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e)]);
        const auto end = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e) + 1]);
        pixels.clear();
        patch_z.clear();
        occluding.clear();
        for (std::size_t i = first; i < end; ++i) {
            Eigen::Vector2d pixel(edges.x[i], edges.y[i]);
            if (distorted) pixel = camera.distortPixel(pixel);
            const EdgeDepth found = foregroundDepth(depth, static_cast<float>(pixel.x()),
                                                    static_cast<float>(pixel.y()), edge_options, sensor);
            pixels.push_back(pixel);
            patch_z.push_back(found.depth);
            occluding.push_back(found.occluding ? 1 : 0);
        }
        z = patch_z;
        if (edge_options.two_sided_depth) sides.correct(edges, first, pixels, depth, jump, scale, z);
        const auto flush = [&] {
            if (piece.size() >= least_piece) {
                for (const std::size_t k : piece) {
                    const std::size_t i = first + k;
                    out.image.addPoint(edges.x[i], edges.y[i], edges.gradient_x[i], edges.gradient_y[i],
                                       edges.strength[i]);
                    out.image.normal_x.push_back(edges.normal_x[i]);
                    out.image.normal_y.push_back(edges.normal_y[i]);
                    const Eigen::Vector3d p =
                        rows.toReference(camera.backProject(edges.x[i], edges.y[i], z[k]), edges.y[i]);
                    out.x.push_back(static_cast<float>(p.x()));
                    out.y.push_back(static_cast<float>(p.y()));
                    out.z.push_back(static_cast<float>(p.z()));
                    out.weight.push_back(static_cast<float>(depthWeight(p.z(), sensor)));
                    out.correction.push_back(z[k] - patch_z[k]);
                    out.occluding.push_back(occluding[k]);
                    out.source.push_back(static_cast<std::int32_t>(i));
                }
                out.image.finishEdge();
            }
            piece.clear();
        };
        for (std::size_t k = 0; k < z.size(); ++k) {
            if (z[k] == 0) continue;
            if (!piece.empty()) {
                const float previous = z[piece.back()];
                const bool gap = k - piece.back() - 1 > most_gap;
                if (gap || std::abs(z[k] - previous) > jump * std::min(z[k], previous)) flush();
            }
            piece.push_back(k);
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
