#include "camera/undistorter.h"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.h"

namespace roevo {
namespace {

constexpr int kOne = 1 << kernels::kFractionBits;

/// A coordinate in 1/32 px as the first of two neighbouring pixels and the way from it to the second; what is
/// outside repeats the outermost pixel.
struct Place {
    int first, fraction;
    Place(double coordinate, int size) {
        // A lens may lead anywhere; 0 where that is no number
        const double inside = std::min(std::max(0.0, coordinate), static_cast<double>(size - 1));
        const int fine = static_cast<int>(std::lrint(kOne * static_cast<float>(inside)));
        first = std::min(fine / kOne, size - 2);
        fraction = fine - first * kOne;
    }
};

}  // namespace

Undistorter::Undistorter(const PinholeCamera& camera) {
    if (!camera.isDistorted()) return;
    width_ = camera.width;
    height_ = camera.height;
    for (int v = 0; v < height_; ++v) {
        for (int u = 0; u < width_; ++u) {
            const Eigen::Vector2d pixel = camera.distortPixel(Eigen::Vector2d(u, v));
            const Place x(pixel.x(), width_), y(pixel.y(), height_);
            offset_.push_back(y.first * width_ + x.first);
            fraction_.push_back(static_cast<std::int16_t>(x.fraction + 256 * y.fraction));
        }
    }
    offset_.resize(offset_.size() + kernels::kRemapPadding);
    fraction_.resize(offset_.size());
}

const cv::Mat& Undistorter::apply(const cv::Mat& image, cv::Mat& buffer) const {
    if (isIdentity()) return image;
    const cv::Mat whole = image.isContinuous() ? image : image.clone();  // as the offsets assume
    buffer.create(height_, width_, CV_8UC1);
    const auto* first = whole.ptr<std::uint8_t>();
    kernels::best().remap(first, first + whole.total(), width_, {offset_.data(), fraction_.data()},
                          width_ * height_, buffer.ptr<std::uint8_t>());
    return buffer;
}

}  // namespace roevo
