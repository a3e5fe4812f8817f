#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "programs/text.h"

namespace roevo {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kFine = 4;  // the strip is drawn this many times larger and shrunk
// In units, a unit being the height of a capital letter
constexpr double kLine = 2.4, kBorder = 1.4, kSwatch = 2.6, kGap = 0.8, kBetween = 2.2, kBar = 11,
                 kBarRoom = 29;
constexpr double kUnitShare = 1. / 66;  // of the picture's shorter side
constexpr int kSmallestUnit = 7;        // pixels
constexpr double kLargestShare = 0.25;  // of the picture, for the strip

double fontScale(double unit) {
    return cv::getFontScaleFromHeight(kFont, static_cast<int>(std::lround(unit)), 1);
}

double textWidth(const std::string& text, int unit) {
    return cv::getTextSize(text, kFont, fontScale(unit * kFine), 1, nullptr).width / double{kFine};
}

cv::Scalar bgr(const Colour& c) {
    return 255 * cv::Scalar(c[2], c[1], c[0]);
}

// The longest of 1, 2, 5 times a power of ten that is not longer than `limit`.
double roundLength(double limit) {
    const double power = std::pow(10, std::floor(std::log10(limit)));
    const double first = limit / power;
    return power * (first >= 5 ? 5 : first >= 2 ? 2 : 1);
}

std::string lengthText(double metres) {
    const auto digits = [](double value) { return plainNumber(std::round(value * 1e6) / 1e6); };
    if (metres >= 1000) return digits(metres / 1000) + " km";
    if (metres >= 1) return digits(metres) + " m";
    return metres >= 0.01 ? digits(100 * metres) + " cm" : digits(1000 * metres) + " mm";
}

}  // namespace

Overlay::Overlay(std::vector<LegendEntry> entries, const Background& background, cv::Size size)
    : entries_(std::move(entries)), background_(background), width_(size.width) {
    const int shorter = std::min(size.width, size.height);
    unit_ = std::max(kSmallestUnit, static_cast<int>(std::lround(kUnitShare * shorter)));
    const double left = kBorder * unit_, right = width_ - left;
    double x = left;
    bool fits = kBarRoom * unit_ <= right - left;
    for (const LegendEntry& entry : entries_) {
        const double width = (kSwatch + kGap) * unit_ + textWidth(entry.text, unit_);
        if (x > left && x + width > right) x = left, ++bar_line_;
        fits = fits && x + width <= right;
        places_.push_back({static_cast<int>(x), bar_line_});
        x += width + kBetween * unit_;
    }
    if (x > left && x + kBarRoom * unit_ > right) ++bar_line_;
    const int height = static_cast<int>(((bar_line_ + 1) * kLine + kBorder) * unit_);
    if (fits && height <= kLargestShare * size.height) height_ = height;
}

cv::Mat Overlay::draw(double pixels_per_metre, bool exact) const {
    const int unit = unit_ * kFine, stroke = std::max(kFine, static_cast<int>(0.13 * unit));
    cv::Mat strip(height_ * kFine, width_ * kFine, CV_8UC3, bgr(background_.colour()));
    const cv::Scalar ink = bgr(background_.ink());
    const auto baseline = [&](int line) { return static_cast<int>((line * kLine + kBorder + 0.5) * unit); };
    const auto write = [&](const std::string& text, int x, int line) {
        cv::putText(strip, text, {x, baseline(line)}, kFont, fontScale(unit), ink, stroke, cv::LINE_AA);
    };
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto& colours = entries_[i].colours;
        const int x = places_[i].x * kFine, y = baseline(places_[i].line) - unit / 2;
        const double part = kSwatch * unit / static_cast<double>(colours.size());
        for (std::size_t k = 0; k < colours.size(); ++k)
            cv::rectangle(strip, {x + static_cast<int>(part * static_cast<double>(k)), y - unit / 5},
                          {x + static_cast<int>(part * static_cast<double>(k + 1)) - 1, y + unit / 5},
                          bgr(colours[k]), cv::FILLED);
        write(entries_[i].text, x + static_cast<int>((kSwatch + kGap) * unit), places_[i].line);
    }

    const double metres = roundLength(kBar * unit_ / pixels_per_metre);
    const int length = static_cast<int>(std::lround(metres * pixels_per_metre * kFine));
    const std::string text = lengthText(metres) + (exact ? "" : " in the middle");
    const int text_left =
                  (width_ * kFine) - static_cast<int>(kBorder * unit + kFine * textWidth(text, unit_)),
              right = text_left - static_cast<int>(kGap * unit), y = baseline(bar_line_) - unit / 2;
    cv::rectangle(strip, {right - length, y - stroke / 2}, {right - 1, y + stroke / 2}, ink, cv::FILLED);
    for (const int x : {right - length, right - stroke})
        cv::rectangle(strip, {x, y - unit / 2}, {x + stroke - 1, y + unit / 2}, ink, cv::FILLED);
    write(text, text_left, bar_line_);
    cv::Mat shrunk;
    cv::resize(strip, shrunk, {width_, height_}, 0, 0, cv::INTER_AREA);
    return shrunk;
}

}  // namespace roevo
