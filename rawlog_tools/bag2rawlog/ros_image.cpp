#include "bag2rawlog/ros_image.h"

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "input/excerpt.h"

namespace roevo {
namespace {

constexpr double kUnitsPerMetre = 5000;

/// The pixels of a message, without copying. @throws std::runtime_error when the message is shorter than it
/// says.
cv::Mat viewOf(const sensor_msgs::Image& message, int type) {
    constexpr std::uint32_t kMaxSide = 1 << 15;
    const std::size_t row_bytes =
        static_cast<std::size_t>(message.width) * static_cast<std::size_t>(CV_ELEM_SIZE(type));
    if (message.width == 0 || message.height == 0 || message.width > kMaxSide || message.height > kMaxSide)
        throw std::runtime_error("image of " + std::to_string(message.width) + "x" +
                                 std::to_string(message.height) + " pixels");
    if (message.step < row_bytes ||
        message.data.size() < static_cast<std::size_t>(message.step) * (message.height - 1) + row_bytes)
        throw std::runtime_error("image data of " + std::to_string(message.data.size()) +
                                 " bytes is too short for " + std::to_string(message.width) + "x" +
                                 std::to_string(message.height) + " " + excerpt(message.encoding));
    return {static_cast<int>(message.height), static_cast<int>(message.width), type,
            const_cast<std::uint8_t*>(message.data.data()), message.step};
}

cv::Mat converted(const cv::Mat& image, int code) {
    cv::Mat out;
    cv::cvtColor(image, out, code);
    return out;
}

}  // namespace

bool isColourEncoding(const std::string& encoding) {
    return encoding == "rgb8" || encoding == "bgr8" || encoding == "rgba8" || encoding == "bgra8" ||
           encoding == "8UC3";
}

bool isGreyEncoding(const std::string& encoding) {
    return encoding == "mono8" || encoding == "8UC1";
}

bool isDepthEncoding(const std::string& encoding) {
    return encoding == "16UC1" || encoding == "32FC1";
}

cv::Mat colourImageOf(const sensor_msgs::Image& message) {
    const std::string& encoding = message.encoding;
    if (isGreyEncoding(encoding)) return viewOf(message, CV_8UC1).clone();
    if (encoding == "bgr8" || encoding == "8UC3") return viewOf(message, CV_8UC3).clone();
    if (encoding == "rgb8") return converted(viewOf(message, CV_8UC3), cv::COLOR_RGB2BGR);
    if (encoding == "rgba8") return converted(viewOf(message, CV_8UC4), cv::COLOR_RGBA2BGR);
    if (encoding == "bgra8") return converted(viewOf(message, CV_8UC4), cv::COLOR_BGRA2BGR);
    throw std::runtime_error("encoding " + excerpt(encoding) + " is no 8-bit colour or grey image");
}

float depthUnitOf(const std::string& encoding) {
    return encoding == "32FC1" ? static_cast<float>(1 / kUnitsPerMetre) : 1e-3f;
}

cv::Mat depthImageOf(const sensor_msgs::Image& message, std::size_t& too_far) {
    if (message.is_bigendian) throw std::runtime_error("big-endian depth is not supported");
    if (message.encoding == "16UC1" || message.encoding == "mono16") return viewOf(message, CV_16UC1).clone();
    if (message.encoding != "32FC1")
        throw std::runtime_error("encoding " + excerpt(message.encoding) + " is no depth image");

    const cv::Mat metres = viewOf(message, CV_32FC1);
    cv::Mat depth(metres.size(), CV_16UC1);
    for (int v = 0; v < metres.rows; v++) {
        const auto* from = metres.ptr<float>(v);
        auto* to = depth.ptr<std::uint16_t>(v);
        for (int u = 0; u < metres.cols; u++) {
            const double units = std::round(from[u] * kUnitsPerMetre);
            const bool fits = units <= 65535;
            if (std::isfinite(units) && !fits) too_far++;
            to[u] = units > 0 && fits ? static_cast<std::uint16_t>(units) : std::uint16_t{0};
        }
    }
    return depth;
}

}  // namespace roevo
