#include "mapping/map_keyframe.h"

#include <algorithm>

#include "line_fit.h"
#include "tracking/kernels.h"

namespace roevo {
namespace {

constexpr int kSlopeSpan = 4;         ///< points to each side: depth is noisy
constexpr float kLeastSpread = 1.0f;  ///< px^2 times points^2; less and a slope cannot be told

/// Arrays that grow by doubling would waste half of their memory.
void reserve(MapKeyframe& keyframe, std::size_t points) {
    OrganizedEdges& image = keyframe.image;
    for (auto* array :
         {&image.x, &image.y, &image.gradient_x, &image.gradient_y, &image.normal_x, &image.normal_y,
          &image.strength, &keyframe.x, &keyframe.y, &keyframe.z, &keyframe.weight}) {
        array->reserve(points + kernels::paddedSize(1));
    }
    image.edge_of.reserve(points);
    keyframe.colours.reserve(points);
}

}  // namespace

void computeSlopes(MapKeyframe& keyframe) {
    const OrganizedEdges& image = keyframe.image;
    keyframe.slope.assign(keyframe.size(), 0);
    for (std::size_t e = 0; e + 1 < image.begin.size(); ++e) {
        for (int i = image.begin[e]; i < image.begin[e + 1]; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const int first = std::max(image.begin[e], i - kSlopeSpan),
                      last = std::min(image.begin[e + 1] - 1, i + kSlopeSpan);
            LineFit<float> line;
            for (int j = first; j <= last; ++j) {
                const auto other = static_cast<std::size_t>(j);
                line.add(image.normal_x[at] * (image.y[other] - image.y[at]) -
                             image.normal_y[at] * (image.x[other] - image.x[at]),
                         keyframe.z[other] - keyframe.z[at]);
            }
            if (line.spread() > kLeastSpread) keyframe.slope[at] = line.slope();
        }
    }
}

void setRowMotion(MapKeyframe& keyframe, const RowMotion& rows, const PinholeCamera& camera) {
    // The row of a point is not kept; where it would be seen is near enough
    exchangeMotion(keyframe.row_motion, rows, keyframe.image.y, keyframe.size(), keyframe.x, keyframe.y,
                   keyframe.z);
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
        const Eigen::Vector2d pixel = camera.project(keyframe.point(i));
        keyframe.image.x[i] = static_cast<float>(pixel.x());
        keyframe.image.y[i] = static_cast<float>(pixel.y());
    }
    computeSlopes(keyframe);
    keyframe.row_motion = rows;
}

void compact(MapKeyframe& keyframe) {
    for (auto* array : {&keyframe.image.gradient_x, &keyframe.image.gradient_y, &keyframe.image.strength}) {
        array->clear();
        array->shrink_to_fit();
    }
}

MapKeyframe toMapKeyframe(const Keyframe& keyframe, const std::vector<Rgb>& colours,
                          const PinholeCamera& camera, int max_points) {
    MapKeyframe out;
    out.id = keyframe.id;
    out.timestamp = keyframe.timestamp;
    out.median_depth = keyframe.median_depth;
    const EdgePoints3D& edges = keyframe.edges;
    const std::size_t limit = static_cast<std::size_t>(std::max(1, max_points));
    const std::size_t stride = std::max<std::size_t>(1, (edges.size() + limit - 1) / limit);
    out.image.clear();
    reserve(out, edges.size() / stride + static_cast<std::size_t>(edges.image.numEdges()));
    for (std::size_t e = 0; e + 1 < edges.image.begin.size(); ++e) {
        const auto first = static_cast<std::size_t>(edges.image.begin[e]);
        const auto end = static_cast<std::size_t>(edges.image.begin[e + 1]);
        for (std::size_t i = first + (end - first - 1) % stride / 2; i < end; i += stride) {
            const Eigen::Vector2d pixel =
                camera.project({static_cast<double>(edges.x[i]), static_cast<double>(edges.y[i]),
                                static_cast<double>(edges.z[i])});
            out.image.addPoint(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                               edges.image.gradient_x[i], edges.image.gradient_y[i], edges.image.strength[i]);
            out.image.normal_x.push_back(edges.image.normal_x[i]);
            out.image.normal_y.push_back(edges.image.normal_y[i]);
            out.x.push_back(edges.x[i]);
            out.y.push_back(edges.y[i]);
            out.z.push_back(edges.z[i]);
            out.weight.push_back(edges.weight[i]);
            out.colours.push_back(colours.at(i));
        }
        out.image.finishEdge();
    }
    computeSlopes(out);
    out.row_motion = keyframe.row_motion;
    out.found.assign(static_cast<std::size_t>(out.image.numEdges()), -1);
    const std::size_t padded = kernels::paddedSize(out.size());
    out.x.resize(padded, 0);
    out.y.resize(padded, 0);
    out.z.resize(padded, 1);
    return out;
}

}  // namespace roevo
