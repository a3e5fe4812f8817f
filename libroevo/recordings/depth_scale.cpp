#include "recordings/depth_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <vector>

#include "tracking/robust.h"

namespace roevo {
namespace {

constexpr double kMinMedian = 0.1, kMaxMedian = 20;  // m
constexpr double kTypical = 2;                       // m
constexpr double kLikelyNear = 0.4, kLikelyFar = 8;  // m: what most recordings are within

/// How far a median is from what is usual, as the logarithm of the factor between them.
double distanceFromTypical(double median) {
    return std::abs(std::log(median / kTypical));
}

template <class Value>
double medianOfKnown(const cv::Mat& depth, Value invalid) {
    std::vector<Value> values;
    for (int row = 0; row < depth.rows; ++row)
        std::copy_if(depth.ptr<Value>(row), depth.ptr<Value>(row) + depth.cols, std::back_inserter(values),
                     [=](Value d) { return d > 0 && d != invalid && std::isfinite(static_cast<double>(d)); });
    return values.empty() ? 0 : medianOf(values);
}

}  // namespace

double medianDepth(const cv::Mat& depth, std::uint16_t invalid) {
    return depth.depth() == CV_16U ? medianOfKnown<std::uint16_t>(depth, invalid)
                                   : medianOfKnown<float>(depth, 0);
}

bool isPlausibleMedianDepth(double metres) {
    return metres >= kMinMedian && metres <= kMaxMedian;
}

std::string likelyDepthScales(double median_units) {
    std::string text;
    std::vector<double> known{1, 100, 256, 1000, 5000, 10000};
    const auto off = [&](double scale) { return distanceFromTypical(median_units / scale); };
    std::sort(known.begin(), known.end(), [&](double a, double b) { return off(a) < off(b); });
    for (const double scale : known) {
        const double median = median_units / scale;
        if (median < kLikelyNear || median > kLikelyFar) continue;
        char one[80];
        std::snprintf(one, sizeof one, "%s %g would give %.3g m", text.empty() ? "depth_scale" : ",", scale,
                      median);
        text += one;
    }
    return text;
}

double unitsPerMetre(double metres_per_unit) {
    const double units = 1 / metres_per_unit, whole = std::round(units);
    return std::abs(units - whole) < 1e-5 * whole ? whole : units;
}

cv::Mat depthInUnits(const cv::Mat& depth, double units, std::size_t& too_far) {
    cv::Mat out(depth.size(), CV_16UC1);
    too_far = 0;
    for (int v = 0; v < depth.rows; v++) {
        const auto* from = depth.ptr<float>(v);
        auto* to = out.ptr<std::uint16_t>(v);
        for (int u = 0; u < depth.cols; u++) {
            const double value = std::round(static_cast<double>(from[u]) * units);
            const bool fits = value <= 65535;
            if (std::isfinite(value) && !fits) too_far++;
            to[u] = value > 0 && fits ? static_cast<std::uint16_t>(value) : std::uint16_t{0};
        }
    }
    return out;
}

std::string tooFarText(std::size_t count) {
    return std::to_string(count) +
           " depth values beyond 13.107 m do not fit into 16 bits and are now unknown";
}

std::string depthScaleFault(const RgbdFrame& frame) {
    constexpr double kFactors[] = {0.0002, 0.001, 0.01, 0.1, 0.2, 5, 10, 100, 1000, 5000};
    const double median = medianDepth(frame.depth);
    if (median == 0 || isPlausibleMedianDepth(median)) return {};

    const auto off = [&](double factor) { return distanceFromTypical(median * factor); };
    const double factor = *std::min_element(std::begin(kFactors), std::end(kFactors),
                                            [&](double a, double b) { return off(a) < off(b); });
    char text[256];
    std::snprintf(
        text, sizeof text,
        "the depth scale makes no sense: the median depth of the first frame is %.4g m (0.1 to 20 m is "
        "plausible); depths are likely to be %g times too %s, which would make it %.3g m",
        median, factor > 1 ? factor : 1 / factor, factor > 1 ? "small" : "large", median * factor);
    return text;
}

}  // namespace roevo
