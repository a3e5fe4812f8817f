#pragma once
#include <opencv2/core.hpp>

namespace roevo::test {

/// In size, type and every pixel.
inline bool same(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace roevo::test
