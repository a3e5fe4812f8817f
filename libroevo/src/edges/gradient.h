#pragma once
#include <opencv2/core/mat.hpp>

#include "kernels/kernels.h"

namespace roevo {

/// Sobel gradient of a grey image (3x3, so a ramp of one grey level per pixel has magnitude 8).
struct Gradient {
    cv::Mat gx, gy;     ///< CV_16SC1
    cv::Mat magnitude;  ///< CV_32FC1, Euclidean norm
    cv::Mat blurred;    ///< buffer of the optional blur

    kernels::GradientView view() const {
        return {gx.ptr<std::int16_t>(), gy.ptr<std::int16_t>(), magnitude.ptr<float>(), magnitude.cols};
    }
};

/// Fills `out` (its buffers are reused from frame to frame).
/// @param blur_sigma  Gaussian blur before the filter, px; 0 for none
void computeGradient(const cv::Mat& grey, double blur_sigma, Gradient& out);

/// Threshold of the gradient magnitude (Sobel units): Otsu's, of the square roots of the magnitudes, which a
/// few strong edges move less than the magnitudes'. Over every second pixel of every second row.
double otsuThreshold(const cv::Mat& magnitude);

}  // namespace roevo
