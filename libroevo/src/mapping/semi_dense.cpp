#include "mapping/semi_dense.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

namespace roevo {
namespace {

/// Half the width of the disc's row `dy` above or below its centre.
int halfWidth(int radius, int dy) {
    return static_cast<int>(std::sqrt(static_cast<double>(radius * radius - dy * dy)));
}

/// Ideal pixels within `radius` of an edge point: not 0.
cv::Mat1b maskAround(const OrganizedEdges& edges, const PinholeCamera& camera, int radius) {
    cv::Mat1b mask(camera.height, camera.width, std::uint8_t{0});
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto u = static_cast<int>(std::lround(edges.x[i])),
                   v = static_cast<int>(std::lround(edges.y[i]));
        for (int dy = -radius; dy <= radius; ++dy) {
            const int reach = halfWidth(radius, dy);
            const int from = std::max(0, u - reach), to = std::min(camera.width - 1, u + reach);
            if (v + dy < 0 || v + dy >= camera.height || from > to) continue;
            std::fill(mask[v + dy] + from, mask[v + dy] + to + 1, std::uint8_t{1});
        }
    }
    return mask;
}

/// The pixel (u, v) of the ideal camera with the nearest pixel of the real one; false where that has no
/// depth.
bool sample(const RgbdFrame& frame, const PinholeCamera& camera, int u, int v, ColouredPoint& out) {
    const Eigen::Vector2d real = camera.distortPixel(Eigen::Vector2d(u, v));
    if (!(real.x() > -0.5 && real.x() < camera.width - 0.5 && real.y() > -0.5 &&
          real.y() < camera.height - 0.5))
        return false;
    const auto ru = static_cast<int>(std::lround(real.x())), rv = static_cast<int>(std::lround(real.y()));
    const float depth = frame.depth.at<float>(rv, ru);
    if (!(depth > 0) || !std::isfinite(depth)) return false;
    out.position = camera.backProject(u, v, static_cast<double>(depth)).cast<float>();
    out.colour = colourAt(frame, ru, rv);
    return true;
}

}  // namespace

Rgb colourAt(const RgbdFrame& frame, int u, int v) {
    if (frame.colour.type() == CV_8UC3 && frame.colour.size() == frame.grey.size()) {
        const auto& bgr = frame.colour.at<cv::Vec3b>(v, u);
        return {bgr[2], bgr[1], bgr[0]};
    }
    const auto level = frame.grey.at<std::uint8_t>(v, u);
    return {level, level, level};
}

std::vector<ColouredPoint> sampleSemiDense(const OrganizedEdges& edges, const RgbdFrame& frame,
                                           const PinholeCamera& camera, int radius_px, int max_points) {
    std::vector<ColouredPoint> points;
    if (frame.depth.empty() || max_points <= 0) return points;
    const cv::Mat1b mask = maskAround(edges, camera, radius_px);
    ColouredPoint point;
    for (int v = 0; v < mask.rows; ++v)
        for (int u = 0; u < mask.cols; ++u)
            if (mask(v, u) != 0 && sample(frame, camera, u, v, point)) points.push_back(point);
    const std::size_t all = points.size(), wanted = static_cast<std::size_t>(max_points);
    if (all <= wanted) return points;
    for (std::size_t k = 0; k < wanted; ++k) points[k] = points[k * all / wanted];
    points.resize(wanted);
    return points;
}

}  // namespace roevo
