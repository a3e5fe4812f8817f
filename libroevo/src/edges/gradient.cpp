#include "edges/gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "indexing.h"
#include "kernels/kernels.h"

namespace roevo {

void computeGradient(const cv::Mat& grey, double blur_sigma, Gradient& out) {
    if (blur_sigma > 0) {
        const int size = 2 * std::max(1, static_cast<int>(std::lround(2 * blur_sigma))) + 1;
        cv::GaussianBlur(grey, out.blurred, {size, size}, blur_sigma, blur_sigma, cv::BORDER_REPLICATE);
    }
    const cv::Mat& source = blur_sigma > 0 ? out.blurred : grey;
    out.gx.create(grey.size(), CV_16SC1);
    out.gy.create(grey.size(), CV_16SC1);
    out.magnitude.create(grey.size(), CV_32FC1);
    const auto& kernels = kernels::best();
    for (int y = 0; y < grey.rows; ++y) {
        kernels.gradient(source.ptr<std::uint8_t>(std::max(0, y - 1)), source.ptr<std::uint8_t>(y),
                         source.ptr<std::uint8_t>(std::min(grey.rows - 1, y + 1)), grey.cols,
                         out.gx.ptr<std::int16_t>(y), out.gy.ptr<std::int16_t>(y),
                         out.magnitude.ptr<float>(y));
    }
}

double otsuThreshold(const cv::Mat& magnitude) {
    constexpr int kBins = 1443;  // 4 * 255 * sqrt(2), rounded up
    std::array<int, kBins> histogram{};
    std::vector<std::int32_t> bins(static_cast<std::size_t>(magnitude.cols + 1) / 2);
    for (int y = 0; y < magnitude.rows; y += 2) {
        const auto* row = magnitude.ptr<float>(y);
        for (std::size_t i = 0; i < bins.size(); ++i)  // apart, so that the compiler makes vectors of it
            bins[i] = static_cast<std::int32_t>(std::min<float>(kBins - 1, row[2 * i]));
        for (const std::int32_t bin : bins) ++at(histogram, bin);
    }
    const auto rootOf = [](int bin) { return std::sqrt(bin + 0.5); };
    double total = 0, sum = 0;
    for (int i = 0; i < kBins; ++i) {
        total += at(histogram, i);
        sum += rootOf(i) * at(histogram, i);
    }
    double below = 0, sum_below = 0, best_variance = -1;
    int best = 0;
    for (int i = 0; i < kBins; ++i) {
        below += at(histogram, i);
        sum_below += rootOf(i) * at(histogram, i);
        const double above = total - below;
        if (below == 0 || above == 0) continue;
        const double difference = sum_below / below - (sum - sum_below) / above;
        const double variance = below * above * difference * difference;
        if (variance > best_variance) {
            best_variance = variance;
            best = i;
        }
    }
    return best + 1;
}

}  // namespace roevo
