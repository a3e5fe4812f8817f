#include "mapping/semi_dense.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "pixels/nearest.h"

namespace roevo {
namespace {

/// Half the width of the disc's row `dy` above or below its centre.
int halfWidth(int radius, int dy) {
    return static_cast<int>(std::sqrt(static_cast<double>(radius * radius - dy * dy)));
}

/// Ideal pixels within `radius` of an edge point: not 0.
cv::Mat1b maskAround(const OrganizedEdges& edges, const PinholeCamera& camera, int radius) {
    cv::Mat1b mask(camera.height, camera.width, std::uint8_t{0});
    std::vector<int> reaches;
    for (int dy = -radius; dy <= radius; ++dy) reaches.push_back(halfWidth(radius, dy));
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto u = nearestInteger(static_cast<double>(edges.x[i])),
                   v = nearestInteger(static_cast<double>(edges.y[i]));
        for (int dy = -radius; dy <= radius; ++dy) {
            const int reach = reaches[static_cast<std::size_t>(dy + radius)];
            const int from = std::max(0, u - reach), to = std::min(camera.width - 1, u + reach);
            if (v + dy < 0 || v + dy >= camera.height || from > to) continue;
            std::fill(mask[v + dy] + from, mask[v + dy] + to + 1, std::uint8_t{1});
        }
    }
    return mask;
}

/// A pixel of the ideal camera, and the nearest one of the real camera.
struct Sample {
    int u, v, real_u, real_v;
};

/// False where the real camera has no depth.
bool hasDepth(const cv::Mat& depth, const PinholeCamera& camera, Sample& sample) {
    sample.real_u = sample.u;
    sample.real_v = sample.v;
    if (camera.isDistorted()) {
        const Eigen::Vector2d real = camera.distortPixel(Eigen::Vector2d(sample.u, sample.v));
        if (!(real.x() > -0.5 && real.x() < camera.width - 0.5 && real.y() > -0.5 &&
              real.y() < camera.height - 0.5))
            return false;
        sample.real_u = nearestInteger(real.x());
        sample.real_v = nearestInteger(real.y());
    }
    const float z = depth.ptr<float>(sample.real_v)[sample.real_u];
    return z > 0 && std::isfinite(z);
}

ColouredPoint pointAt(const RgbdFrame& frame, const PinholeCamera& camera, const Sample& sample) {
    const float depth = frame.depth.ptr<float>(sample.real_v)[sample.real_u];
    return {camera.backProject(sample.u, sample.v, static_cast<double>(depth)).cast<float>(),
            colourAt(frame, sample.real_u, sample.real_v)};
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
    std::vector<Sample> samples;
    for (int v = 0; v < mask.rows; ++v) {
        const std::uint8_t* row = mask[v];
        for (int u = 0; u < mask.cols; ++u) {
            Sample sample{u, v, 0, 0};
            if (row[u] != 0 && hasDepth(frame.depth, camera, sample)) samples.push_back(sample);
        }
    }
    const std::size_t all = samples.size(), wanted = std::min(all, static_cast<std::size_t>(max_points));
    points.reserve(wanted);
    for (std::size_t k = 0; k < wanted; ++k)
        points.push_back(pointAt(frame, camera, samples[k * all / wanted]));
    return points;
}

}  // namespace roevo
