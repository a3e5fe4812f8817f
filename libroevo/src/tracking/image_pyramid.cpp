#include "tracking/image_pyramid.h"

#include "kernels/kernels.h"

namespace roevo {

void ImagePyramid::build(const cv::Mat& grey, int levels) {
    constexpr int kSmallest = 24;  // px; patches need some room
    levels_.resize(static_cast<std::size_t>(levels));
    levels_[0] = grey;
    for (int i = 1; i < levels; ++i) {
        const cv::Mat& below = levels_[static_cast<std::size_t>(i) - 1];
        const cv::Size half(below.cols / 2, below.rows / 2);
        if (half.width < kSmallest || half.height < kSmallest) {
            levels_.resize(static_cast<std::size_t>(i));
            break;
        }
        // An odd last row or column is left out, so that every level's pixel is the mean of exactly four
        cv::Mat& level = at(levels_, i);
        level.create(half, CV_8UC1);
        for (int y = 0; y < half.height; ++y)
            kernels::best().halve(below.ptr<std::uint8_t>(2 * y), below.ptr<std::uint8_t>(2 * y + 1),
                                  half.width, level.ptr<std::uint8_t>(y));
    }
}

}  // namespace roevo
