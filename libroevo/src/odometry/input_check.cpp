#include "input_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

namespace roevo {
namespace {

Fault stampFault(double timestamp, double last) {
    constexpr double kLatest = 1e10;  // s, three hundred years after 1970
    if (!std::isfinite(timestamp)) return {"time stamp is not finite"};
    if (std::abs(timestamp) > kLatest)
        return {"time stamp is no time in seconds (it may be missing, or count nanoseconds)"};
    if (timestamp == last) return {"repeated time stamp"};
    if (timestamp < last) return {kTimeBackward};
    return {};
}

}  // namespace

Fault StampCheck::take(double timestamp) {
    if (Fault fault = stampFault(timestamp, last_)) return fault;
    if (std::isfinite(last_)) {
        // One damaged stamp far ahead would have all frames after it rejected, as going backward: a leap is
        // not believed until the next frame comes soon after it. Frames may be minutes apart, all of them
        constexpr double kLeap = 60, kFarApart = 3600;  // s
        const double ahead = timestamp - last_;
        const auto leap = std::exchange(leap_, std::nullopt);
        const bool goes_on =
            leap && timestamp > *leap && timestamp - *leap <= std::min(*leap - last_, kFarApart);
        if (ahead > kLeap && !goes_on) {
            leap_ = timestamp;
            return {"time stamp leaps ahead by " + std::to_string(static_cast<int>(std::min(ahead, 1e9))) +
                    " s; the next frame tells whether it is damaged"};
        }
    }
    last_ = timestamp;
    return {};
}

Fault inputFault(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp) {
    if (Fault fault = stampFault(frame.timestamp, last_timestamp)) return fault;
    if (frame.grey.empty())
        return {frame.colour.empty() ? "no colour image" : "no grey image beside the colour image"};
    if (frame.grey.type() != CV_8UC1) return {"grey image is not 8-bit with one channel"};
    const auto fits = [&](const cv::Mat& image) {
        return image.cols == camera.width && image.rows == camera.height;
    };
    const auto sizes = [&](const char* what, const cv::Mat& image) {
        const auto text = [](int width, int height) {
            return std::to_string(width) + "x" + std::to_string(height);
        };
        return Fault{what + text(image.cols, image.rows) + " but the camera is " +
                     text(camera.width, camera.height)};
    };
    if (!frame.colour.empty() && frame.colour.type() != CV_8UC3)
        return {"colour image is not 8-bit with three channels"};
    if (!frame.colour.empty() && !fits(frame.colour)) return sizes("colour image is ", frame.colour);
    if (!fits(frame.grey)) return sizes("grey image is ", frame.grey);
    if (!frame.mask.empty() && frame.mask.type() != CV_8UC1) return {"mask is not 8-bit with one channel"};
    if (!frame.mask.empty() && !fits(frame.mask)) return sizes("mask is ", frame.mask);
    if (frame.depth.empty()) return {};
    if (frame.depth.type() != CV_32FC1) return {"depth image is not 32-bit float with one channel"};
    if (!fits(frame.depth)) return sizes("depth image is ", frame.depth);
    return {};
}

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size()) return false;
    for (int y = 0; y < a.rows; ++y)
        if (std::memcmp(a.ptr(y), b.ptr(y), static_cast<std::size_t>(a.cols)) != 0) return false;
    return true;
}

}  // namespace roevo
