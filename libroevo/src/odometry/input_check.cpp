#include "input_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace roevo {

Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp) {
    using Kind = Fault::Kind;
    if (!std::isfinite(frame.timestamp)) return {Kind::kTimeNotFinite, {}};
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
    if (!fits(frame.grey)) return sizes(Kind::kColourSize, frame.grey);
    if (frame.depth.empty()) return {};
    if (frame.depth.type() != CV_32FC1) return {Kind::kDepthType, {}};
    if (!fits(frame.depth)) return sizes(Kind::kDepthSize, frame.depth);
    return {};
}

double FrameClock::timeOf(double stamp, double last) {
    constexpr double kLeap = 60, kFarApart = 3600;  // s
    leap_fault_ = {};
    if (!std::isfinite(stamp)) return stamp;
    const auto ahead = [&] { return set_back_.empty() ? 0 : set_back_.back().ahead; };
    const std::optional<double> before = std::exchange(leap_, std::nullopt);
    const double by = stamp + ahead() - last;
    if (std::abs(by) <= kLeap || !std::isfinite(last)) return stamp + ahead();
    const double step = before ? stamp - *before : 0;
    // Frames may be minutes apart, all of them; two damaged stamps are not likely to be
    const bool goes_on = step > 0 && step <= std::clamp(*before + ahead() - last, kLeap, kFarApart);
    if (!goes_on) {
        leap_ = stamp;
        leap_fault_ = {by > 0 ? Fault::Kind::kTimeLeap : Fault::Kind::kTimeSetBack,
                       {static_cast<int>(std::min(std::abs(by), 1e9))}};
    } else if (by < 0) {
        // The frame that was not believed came a step after the last one, and this one a step after it
        set_back_.push_back({last + step, last + 2 * step - stamp});
    }
    return stamp + ahead();
}

double FrameClock::stampAt(double time) const {
    const auto next = std::upper_bound(set_back_.begin(), set_back_.end(), time,
                                       [](double t, const Setting& setting) { return t < setting.since; });
    return next == set_back_.begin() ? time : time - std::prev(next)->ahead;
}

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size()) return false;
    for (int y = 0; y < a.rows; ++y)
        if (std::memcmp(a.ptr(y), b.ptr(y), static_cast<std::size_t>(a.cols)) != 0) return false;
    return true;
}

}  // namespace roevo
