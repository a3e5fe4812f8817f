#pragma once
#include <random>
#include <string>
#include <vector>

#include "edges/canny.h"
#include "edges/gradient.h"

namespace roevo::testing {

inline EdgeMask maskFrom(const cv::Mat& mask) {
    EdgeMask edges;
    edges.mask = mask.clone();
    for (int y = 0; y < mask.rows; ++y) {
        for (int x = 0; x < mask.cols; ++x) {
            if (mask.at<std::uint8_t>(y, x) != 0) edges.pixels.push_back(y * mask.cols + x);
        }
    }
    return edges;
}

/// Mask drawn with '#', with a border around it.
inline EdgeMask drawnMask(const std::vector<std::string>& rows) {
    constexpr int b = EdgeMask::kBorder;
    cv::Mat mask = cv::Mat::zeros(static_cast<int>(rows.size()) + 2 * b,
                                  static_cast<int>(rows[0].size()) + 2 * b, CV_8UC1);
    for (std::size_t y = 0; y < rows.size(); ++y) {
        for (std::size_t x = 0; x < rows[y].size(); ++x) {
            if (rows[y][x] == '#')
                mask.at<std::uint8_t>(static_cast<int>(y) + b, static_cast<int>(x) + b) = 1;
        }
    }
    return maskFrom(mask);
}

inline EdgeMask randomMask(std::mt19937& random, int width, int height, double share) {
    cv::Mat mask = cv::Mat::zeros(height, width, CV_8UC1);
    std::bernoulli_distribution is_edge(share);
    for (int y = EdgeMask::kBorder; y < height - EdgeMask::kBorder; ++y) {
        for (int x = EdgeMask::kBorder; x < width - EdgeMask::kBorder; ++x) {
            mask.at<std::uint8_t>(y, x) = is_edge(random) ? 1 : 0;
        }
    }
    return maskFrom(mask);
}

/// Gradient of the same direction and size everywhere, so that only the mask decides.
inline Gradient evenGradient(const cv::Size& size, int gx = 400, int gy = 0) {
    Gradient gradient;
    gradient.gx = cv::Mat(size, CV_16SC1, cv::Scalar(gx));
    gradient.gy = cv::Mat(size, CV_16SC1, cv::Scalar(gy));
    gradient.magnitude = cv::Mat(size, CV_32FC1, cv::Scalar(std::hypot(gx, gy)));
    return gradient;
}

}  // namespace roevo::testing
