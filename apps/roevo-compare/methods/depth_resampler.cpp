#include "depth_resampler.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace roevo {
namespace {

constexpr float kStep = 0.03F;  ///< neighbours whose depths differ by more, relatively, are two surfaces

}  // namespace

PinholeCamera centredCamera(const PinholeCamera& camera, int width, int height) {
    // Pixels reach half a pixel beyond the centres of the outermost ones.
    const double half_width = std::max(camera.cx + 0.5, camera.width - 0.5 - camera.cx) / camera.fx;
    const double half_height = std::max(camera.cy + 0.5, camera.height - 0.5 - camera.cy) / camera.fy;
    PinholeCamera centred;
    centred.width = width;
    centred.height = height;
    centred.fx = centred.fy = std::min(width / 2.0 / half_width, height / 2.0 / half_height);
    centred.cx = (width - 1) / 2.0;
    centred.cy = (height - 1) / 2.0;
    return centred;
}

DepthResampler::DepthResampler(const PinholeCamera& source, const PinholeCamera& target,
                               const SensorOptions& sensor)
    : position_(target.height, target.width, CV_32FC2),
      min_depth_(static_cast<float>(sensor.min_depth)),
      max_depth_(static_cast<float>(sensor.depth_limit)) {
    const auto inside = [&](const Eigen::Vector2d& pixel) {
        return pixel.x() > -0.5 && pixel.x() < source.width - 0.5 && pixel.y() > -0.5 &&
               pixel.y() < source.height - 0.5;
    };
    for (int v = 0; v < target.height; ++v) {
        auto* row = position_.ptr<cv::Vec2f>(v);
        for (int u = 0; u < target.width; ++u) {
            const Eigen::Vector2d ideal = source.project(target.backProject(u, v, 1));
            const Eigen::Vector2d real = source.distortPixel(ideal);
            // Far outside of the image the lens model folds back into it.
            row[u] = inside(ideal) && inside(real) ? cv::Vec2f(static_cast<float>(std::max(real.x(), 0.0)),
                                                               static_cast<float>(std::max(real.y(), 0.0)))
                                                   : cv::Vec2f(-1, -1);
        }
    }
}

const cv::Mat& DepthResampler::apply(const cv::Mat& depth, cv::Mat& buffer, float unknown) const {
    buffer.create(position_.size(), CV_32FC1);
    const auto valid = [&](float z) { return z >= min_depth_ && z <= max_depth_; };
    for (int v = 0; v < position_.rows; ++v) {
        const auto* positions = position_.ptr<cv::Vec2f>(v);
        auto* row = buffer.ptr<float>(v);
        for (int u = 0; u < position_.cols; ++u) {
            row[u] = unknown;
            const float x = positions[u][0], y = positions[u][1];
            if (x < 0) continue;
            const int x0 = std::min(static_cast<int>(x), depth.cols - 2),
                      y0 = std::min(static_cast<int>(y), depth.rows - 2);
            const float a = std::min(x - static_cast<float>(x0), 1.F),
                        b = std::min(y - static_cast<float>(y0), 1.F);
            const auto *upper = depth.ptr<float>(y0) + x0, *lower = depth.ptr<float>(y0 + 1) + x0;
            const auto [nearest, farthest] = std::minmax({upper[0], upper[1], lower[0], lower[1]});
            if (valid(nearest) && valid(farthest) && farthest - nearest <= kStep * nearest) {
                row[u] =
                    (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
            } else {
                const float z = (b < 0.5F ? upper : lower)[a < 0.5F ? 0 : 1];
                if (valid(z)) row[u] = z;
            }
        }
    }
    return buffer;
}

int countKnown(const cv::Mat& depth) {
    return cv::countNonZero(depth > 0);
}

}  // namespace roevo
