#include "camera/undistorter.h"

#include <opencv2/imgproc.hpp>

namespace roevo {

Undistorter::Undistorter(const PinholeCamera& camera) {
    if (!camera.isDistorted()) return;
    cv::Mat source(camera.height, camera.width, CV_32FC2);
    for (int v = 0; v < camera.height; ++v) {
        auto* row = source.ptr<cv::Vec2f>(v);
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector2d pixel = camera.distortPixel(Eigen::Vector2d(u, v));
            row[u] = cv::Vec2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
        }
    }
    cv::convertMaps(source, cv::noArray(), map_, fractions_, CV_16SC2);
}

const cv::Mat& Undistorter::apply(const cv::Mat& image, cv::Mat& buffer) const {
    if (isIdentity()) return image;
    cv::remap(image, buffer, map_, fractions_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return buffer;
}

}  // namespace roevo
