#include "edges/canny.h"

#include <algorithm>

#include "kernels/kernels.h"

namespace roevo {
namespace {

constexpr int kBits = 64;

/// Where the bits of an image's pixels are: rows of words, with an empty word before and after them.
struct BitRows {
    int columns, rows;  ///< px, within the border
    std::size_t words;  ///< of a row
    explicit BitRows(const cv::Size& size)
        : columns(size.width - 2 * EdgeMask::kBorder),
          rows(size.height - 2 * EdgeMask::kBorder),
          words(static_cast<std::size_t>((columns + kBits - 1) / kBits + 2)) {}
    /// There is an empty row above and below.
    std::size_t size() const { return words * static_cast<std::size_t>(rows + 2); }
    std::size_t firstWord(int row) const { return words * static_cast<std::size_t>(row + 1) + 1; }
};

/// Sets a bit of `weak` for each ridge of at least `low`, or of `strong` from `high` on.
void markRidges(const Gradient& gradient, float low, float high, const BitRows& bits, EdgeMask& out) {
    constexpr int kBorder = EdgeMask::kBorder;
    static_assert(kBits == kernels::kMostRidges);
    const auto stride = static_cast<std::ptrdiff_t>(gradient.magnitude.step1());
    const auto& kernels = kernels::best();
    for (int row = 0; row < bits.rows; ++row) {
        const auto* magnitude = gradient.magnitude.ptr<float>(row + kBorder) + kBorder;
        const auto* gx = gradient.gx.ptr<std::int16_t>(row + kBorder) + kBorder;
        const auto* gy = gradient.gy.ptr<std::int16_t>(row + kBorder) + kBorder;
        std::size_t word = bits.firstWord(row);
        for (int first = 0; first < bits.columns; first += kBits, ++word) {
            const int count = std::min(kBits, bits.columns - first);
            const kernels::Ridges ridges =
                kernels.ridges(magnitude + first, stride, gx + first, gy + first, count, low, high);
            out.strong[word] = ridges.strong;
            out.weak[word] = ridges.all & ~ridges.strong;
        }
    }
}

/// Hysteresis: weak pixels that strong ones reach become strong, too.
void followWeak(const BitRows& bits, EdgeMask& out) {
    auto& queue = out.pixels;
    queue.clear();
    const auto adopt = [&](std::size_t word, std::uint64_t reached) {
        const std::uint64_t found = reached & out.weak[word];
        out.weak[word] ^= found;
        out.strong[word] |= found;
        for (std::uint64_t rest = found; rest != 0; rest &= rest - 1)
            queue.push_back(static_cast<std::int32_t>(kBits * word) + __builtin_ctzll(rest));
    };
    for (int row = 0; row < bits.rows; ++row) {
        const std::size_t first = bits.firstWord(row);
        const auto column = [&](std::size_t word) {
            return out.strong[word - bits.words] | out.strong[word] | out.strong[word + bits.words];
        };
        std::uint64_t before = 0, here = column(first);
        for (std::size_t word = first; word < first + bits.words - 2; ++word) {
            const std::uint64_t after = column(word + 1);
            if (out.weak[word] != 0)
                adopt(word, here | here << 1 | here >> 1 | before >> (kBits - 1) | after << (kBits - 1));
            before = here;
            here = after;
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const auto pixel = static_cast<std::size_t>(queue[i]);
        const std::uint64_t centre = std::uint64_t{1} << pixel % kBits;
        for (const std::size_t word :
             {pixel / kBits - bits.words, pixel / kBits, pixel / kBits + bits.words}) {
            adopt(word, centre | centre << 1 | centre >> 1);
            if ((centre & 1) != 0) adopt(word - 1, std::uint64_t{1} << (kBits - 1));
            if (centre >> (kBits - 1) != 0) adopt(word + 1, 1);
        }
    }
}

/// Lists the strong pixels in raster order.
void listStrong(const BitRows& bits, EdgeMask& out) {
    auto* mask = out.mask.ptr<std::uint8_t>();
    std::size_t count = 0;
    for (int row = 0; row < bits.rows; ++row) {
        if (const std::size_t room = count + bits.words * kBits; out.pixels.size() < room)
            out.pixels.resize(2 * room);
        std::int32_t pixel = (row + EdgeMask::kBorder) * out.mask.cols + EdgeMask::kBorder;
        const std::size_t first = bits.firstWord(row);
        for (std::size_t word = first; word < first + bits.words - 2; ++word, pixel += kBits) {
            for (std::uint64_t rest = out.strong[word]; rest != 0; rest &= rest - 1) {
                const std::int32_t p = pixel + __builtin_ctzll(rest);
                out.pixels[count++] = p;
                mask[p] = 1;
            }
        }
    }
    out.pixels.resize(count);
}

}  // namespace

CannyThresholds cannyThresholds(const Gradient& gradient, const EdgeOptions& options) {
    const double high =
        std::max(options.min_high_threshold, options.canny_factor * otsuThreshold(gradient.magnitude));
    return {options.canny_low_ratio * high, high};
}

void canny(const Gradient& gradient, const CannyThresholds& thresholds, EdgeMask& out) {
    const cv::Size size = gradient.magnitude.size();
    if (out.mask.size() == size) {  // what it shows are its pixels
        auto* mask = out.mask.ptr<std::uint8_t>();
        for (const std::int32_t p : out.pixels) mask[p] = 0;
    } else {
        out.mask.create(size, CV_8UC1);  // continuous
        out.mask.setTo(0);
    }
    out.pixels.clear();
    if (std::min(size.width, size.height) <= 2 * EdgeMask::kBorder) return;
    const BitRows bits(size);
    if (out.strong.size() != bits.size()) {
        out.strong.assign(bits.size(), 0);
        out.weak.assign(bits.size(), 0);
    }
    markRidges(gradient, static_cast<float>(thresholds.low), static_cast<float>(thresholds.high), bits, out);
    followWeak(bits, out);
    listStrong(bits, out);
}

}  // namespace roevo
