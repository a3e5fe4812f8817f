#include "input_check.h"

#include <cmath>

namespace roevo {

std::string faultOf(const RgbdFrame& frame, const PinholeCamera& camera, double last_timestamp) {
    if (!std::isfinite(frame.timestamp)) return "time stamp is not finite";
    if (frame.timestamp <= last_timestamp) {
        return frame.timestamp == last_timestamp ? "repeated time stamp" : "time stamp goes backward";
    }
    if (frame.grey.empty()) return "no colour image";
    if (frame.grey.type() != CV_8UC1) return "grey image is not 8-bit with one channel";
    const auto differs = [&](const cv::Mat& image) {
        return image.cols != camera.width || image.rows != camera.height;
    };
    const auto sizeText = [](const cv::Mat& image) {
        return std::to_string(image.cols) + "x" + std::to_string(image.rows);
    };
    const std::string expected = std::to_string(camera.width) + "x" + std::to_string(camera.height);
    if (differs(frame.grey))
        return "colour image is " + sizeText(frame.grey) + " but the camera is " + expected;
    if (!frame.depth.empty() && frame.depth.type() != CV_32FC1) return "depth image is not 32-bit float";
    if (!frame.depth.empty() && differs(frame.depth)) {
        return "depth image is " + sizeText(frame.depth) + " but the camera is " + expected;
    }
    return {};
}

}  // namespace roevo
