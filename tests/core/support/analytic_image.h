#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace roevo::testing {

/// 8-bit image of intensity(x, y), grey levels, averaged over the area of each pixel (pixel centres at
/// integers).
template <class Intensity>
cv::Mat renderGrey(int width, int height, Intensity&& intensity, int samples = 8) {
    cv::Mat image(height, width, CV_8UC1);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            double sum = 0;
            for (int j = 0; j < samples; ++j) {
                for (int i = 0; i < samples; ++i) {
                    sum += intensity(u - 0.5 + (i + 0.5) / samples, v - 0.5 + (j + 0.5) / samples);
                }
            }
            const double mean = std::clamp(sum / (samples * samples), 0.0, 255.0);
            image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(std::lround(mean));
        }
    }
    return image;
}

}  // namespace roevo::testing
