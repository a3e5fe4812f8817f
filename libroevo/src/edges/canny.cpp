#include "edges/canny.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "pixels/pixel_kernels.h"

namespace roevo {
namespace {

constexpr std::uint8_t kNone = 0, kEdge = 1, kWeak = 2;

/// Magnitudes one step before and after (x, y) along the gradient, interpolated between the two neighbours
/// that the gradient line passes, and that step in pixels.
struct Neighbours {
    float before, after;
    float step_x, step_y;
};

inline Neighbours alongGradient(const float* magnitude, std::ptrdiff_t stride, int gx, int gy) {
    const bool by_column = std::abs(gx) >= std::abs(gy);
    const auto x = static_cast<float>(gx), y = static_cast<float>(gy);
    const float slope = by_column ? y / x : x / y, share = std::abs(slope);
    const std::ptrdiff_t step = by_column ? 1 : stride, across = by_column ? stride : 1;
    const std::ptrdiff_t side = slope >= 0 ? across : -across;
    const float after = magnitude[step] + share * (magnitude[step + side] - magnitude[step]);
    const float before = magnitude[-step] + share * (magnitude[-step - side] - magnitude[-step]);
    return by_column ? Neighbours{before, after, 1, slope} : Neighbours{before, after, slope, 1};
}

/// Marks ridges of at least `low` in the mask, strong ones from `high` on as edges, and lists these.
void markRidges(const Gradient& gradient, float low, float high, EdgeMask& out) {
    constexpr int kBorder = EdgeMask::kBorder;
    const int width = gradient.magnitude.cols, height = gradient.magnitude.rows;
    const auto stride = static_cast<std::ptrdiff_t>(gradient.magnitude.step1());
    const auto& kernels = pixels::best();
    for (int y = kBorder; y < height - kBorder; ++y) {
        const auto* magnitude = gradient.magnitude.ptr<float>(y);
        const auto* gx = gradient.gx.ptr<std::int16_t>(y);
        const auto* gy = gradient.gy.ptr<std::int16_t>(y);
        auto* mask = out.mask.ptr<std::uint8_t>(y);
        for (int first = kBorder; first < width - kBorder; first += pixels::kMostRidges) {
            const int count = std::min(pixels::kMostRidges, width - kBorder - first);
            std::uint64_t ridges =
                kernels.ridges(magnitude + first, stride, gx + first, gy + first, count, low);
            for (; ridges != 0; ridges &= ridges - 1) {
                const int x = first + __builtin_ctzll(ridges);
                const bool strong = magnitude[x] >= high;
                mask[x] = strong ? kEdge : kWeak;
                if (strong) out.pixels.push_back(y * width + x);
            }
        }
    }
}

/// Hysteresis: weak pixels that the listed ones reach become edges, too.
void followWeak(EdgeMask& out) {
    auto* mask = out.mask.ptr<std::uint8_t>();
    const int width = out.mask.cols;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const std::int32_t centre = out.pixels[i];
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                const std::int32_t neighbour = centre + dy * width + dx;
                if (mask[neighbour] != kWeak) continue;
                mask[neighbour] = kEdge;
                out.pixels.push_back(neighbour);
            }
        }
    }
}

/// Lists the edge pixels in raster order and drops weak pixels that nothing reached; eight pixels at a time,
/// because few are either. What is left of the image at the end is in the border.
void listInRasterOrder(EdgeMask& out) {
    out.pixels.clear();
    auto* mask = out.mask.ptr<std::uint8_t>();
    const auto total = static_cast<std::int32_t>(out.mask.total());
    for (std::int32_t p = 0; p + 8 <= total; p += 8) {
        std::uint64_t eight;
        std::memcpy(&eight, mask + p, sizeof eight);
        if (eight == 0) continue;
        eight &= 0x0101010101010101U * kEdge;
        std::memcpy(mask + p, &eight, sizeof eight);
        for (; eight != 0; eight &= eight - 1) out.pixels.push_back(p + __builtin_ctzll(eight) / 8);
    }
}

}  // namespace

void canny(const Gradient& gradient, double low, double high, EdgeMask& out) {
    const cv::Size size = gradient.magnitude.size();
    out.mask.create(size, CV_8UC1);  // continuous
    out.mask.setTo(kNone);
    out.pixels.clear();
    if (std::min(size.width, size.height) <= 2 * EdgeMask::kBorder) return;
    markRidges(gradient, static_cast<float>(low), static_cast<float>(high), out);
    followWeak(out);
    listInRasterOrder(out);
}

cv::Point2f subpixelOffset(const Gradient& gradient, int x, int y) {
    const auto* magnitude = gradient.magnitude.ptr<float>(y) + x;
    const int gx = gradient.gx.at<std::int16_t>(y, x), gy = gradient.gy.at<std::int16_t>(y, x);
    if (gx == 0 && gy == 0) return {0, 0};
    const Neighbours n =
        alongGradient(magnitude, static_cast<std::ptrdiff_t>(gradient.magnitude.step1()), gx, gy);
    // Through the logarithms: a blurred step has a Gaussian ridge, whose logarithm is a parabola
    const float floor = 0.33F * magnitude[0];  // where a sharp ridge ends, the logarithm would run away
    const float before = std::log(n.before + floor), here = std::log(magnitude[0] + floor),
                after = std::log(n.after + floor);
    const float curvature = before - 2 * here + after;
    if (!(curvature < 0)) return {0, 0};
    const float vertex = std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
    return {vertex * n.step_x, vertex * n.step_y};
}

}  // namespace roevo
