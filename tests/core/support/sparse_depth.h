#pragma once
#include <opencv2/core/mat.hpp>

namespace roevo::testing {

/// Only every n-th pixel of every n-th row keeps its depth.
/// @param first  row and column
inline cv::Mat everyNth(const cv::Mat& depth, int n, int first) {
    cv::Mat sparse(depth.size(), CV_32FC1, cv::Scalar(0));
    for (int v = first; v < depth.rows; v += n)
        for (int u = first; u < depth.cols; u += n) sparse.at<float>(v, u) = depth.at<float>(v, u);
    return sparse;
}

}  // namespace roevo::testing
