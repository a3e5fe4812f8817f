#include "mapping/map_keyframe.h"

#include "line_fit.h"

namespace roevo {
namespace {

constexpr std::size_t kSlopeSpan = 4;  ///< points to each side: depth is noisy
constexpr float kLeastSpread = 1.0f;   ///< px^2 times points^2; less and a slope cannot be told

}  // namespace

void computeSlopes(KeyframeEdges& edges) {
    const OrganizedEdges& image = edges.image;
    edges.slope.assign(edges.size(), 0);
    for (int e = 0; e < image.numEdges(); ++e) {
        const IndexRange own = image.pointsOf(e);
        for (std::size_t i = own.first; i < own.end; ++i) {
            const auto [first, end] = own.around(i, kSlopeSpan);
            LineFit<float> line;
            for (std::size_t j = first; j < end; ++j)
                line.add(image.normal_x[i] * (image.y[j] - image.y[i]) -
                             image.normal_y[i] * (image.x[j] - image.x[i]),
                         edges.points.z[j] - edges.points.z[i]);
            if (line.spread() > kLeastSpread) edges.slope[i] = line.slope();
        }
    }
}

void setRowMotion(MapKeyframe& keyframe, const RowMotion& rows, const PinholeCamera& camera) {
    // The row of a point is not kept; where it would be seen is near enough
    exchangeMotion(keyframe.row_motion, rows, keyframe.image.y, keyframe.size(), keyframe.points);
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
        const Eigen::Vector2d pixel = camera.project(keyframe.points.at(i));
        keyframe.image.x[i] = static_cast<float>(pixel.x());
        keyframe.image.y[i] = static_cast<float>(pixel.y());
    }
    computeSlopes(keyframe);
    keyframe.row_motion = rows;
}

MapKeyframe toMapKeyframe(const Keyframe& keyframe, const std::vector<Rgb>& colours,
                          const PinholeCamera& camera, int max_points) {
    MapKeyframe out;
    out.id = keyframe.id;
    out.median_depth = keyframe.median_depth;
    out.clusters = keyframe.clusters;
    const EdgePoints3D& edges = keyframe.edges;
    const std::size_t stride = strideFor(edges.size(), max_points);
    for (int e = 0; e < edges.image.numEdges(); ++e) {
        const auto [first, end] = edges.image.pointsOf(e);
        for (std::size_t i = first + (end - first - 1) % stride / 2; i < end; i += stride) {
            const Eigen::Vector3d point = edges.points.at(i);
            const Eigen::Vector2d pixel = camera.project(point);
            out.image.x.push_back(static_cast<float>(pixel.x()));
            out.image.y.push_back(static_cast<float>(pixel.y()));
            out.image.normal_x.push_back(edges.image.normal_x[i]);
            out.image.normal_y.push_back(edges.image.normal_y[i]);
            out.points.add(point);
            out.weight.push_back(edges.weight[i]);
            out.colours.push_back(colours.at(i));
        }
        out.image.finishEdge();
    }
    out.image.numberPoints();
    computeSlopes(out);
    out.row_motion = keyframe.row_motion;
    out.found.assign(static_cast<std::size_t>(out.image.numEdges()), -1);
    out.points.pad();
    return out;
}

}  // namespace roevo
