#include "input_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace roevo {

Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp) {
    using Kind = Fault::Kind;
    constexpr double kLatest = 1e10;  // s, three hundred years after 1970
    if (!std::isfinite(frame.timestamp)) return {Kind::kTimeNotFinite, {}};
    if (std::abs(frame.timestamp) > kLatest) return {Kind::kTimeUnit, {}};
    if (frame.timestamp == last_timestamp) return {Kind::kTimeRepeated, {}};
    if (frame.timestamp < last_timestamp) return {Kind::kTimeBackward, {}};
    if (frame.grey.empty()) return {Kind::kNoColour, {}};
    if (frame.grey.type() != CV_8UC1) return {Kind::kGreyType, {}};
    const auto fits = [&](const cv::Mat& image) {
        return image.cols == camera.width && image.rows == camera.height;
    };
    const auto sizes = [&](Kind kind, const cv::Mat& image) {
        return Fault{kind, {image.cols, image.rows, camera.width, camera.height}};
    };
    if (!frame.colour.empty() && frame.colour.type() != CV_8UC3) return {Kind::kColourType, {}};
    if (!frame.colour.empty() && !fits(frame.colour)) return sizes(Kind::kColourSize, frame.colour);
    if (!fits(frame.grey)) return sizes(Kind::kGreySize, frame.grey);
    if (!frame.mask.empty() && frame.mask.type() != CV_8UC1) return {Kind::kMaskType, {}};
    if (!frame.mask.empty() && !fits(frame.mask)) return sizes(Kind::kMaskSize, frame.mask);
    if (frame.depth.empty()) return {};
    if (frame.depth.type() != CV_32FC1) return {Kind::kDepthType, {}};
    if (!fits(frame.depth)) return sizes(Kind::kDepthSize, frame.depth);
    return {};
}

Fault LeapCheck::check(double timestamp, double last_timestamp) {
    constexpr double kLeap = 60, kFarApart = 3600;  // s
    const double ahead = timestamp - last_timestamp;
    // Frames may be minutes apart, all of them; two damaged stamps are not likely to be
    const bool goes_on =
        leap_ && timestamp > *leap_ && timestamp - *leap_ <= std::min(*leap_ - last_timestamp, kFarApart);
    leap_.reset();
    if (ahead <= kLeap || goes_on) return {};
    leap_ = timestamp;
    return {Fault::Kind::kTimeLeap, {static_cast<int>(std::min(ahead, 1e9))}};
}

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size()) return false;
    for (int y = 0; y < a.rows; ++y)
        if (std::memcmp(a.ptr(y), b.ptr(y), static_cast<std::size_t>(a.cols)) != 0) return false;
    return true;
}

}  // namespace roevo
